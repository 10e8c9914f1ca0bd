// The class reference (gdextension/doc_classes/*.xml, compiled in) handed to the editor's help.
#pragma once

#include <gdextension_interface.h>

namespace spidar {

// The XML texts, written by the build.
extern const char *const kClassDocumentation[];
extern const int kClassDocumentationCount;

// In the entry function: finds the editor's loader, where there is one.
void prepare_class_documentation(GDExtensionInterfaceGetProcAddress get_proc_address) noexcept;
// At the editor's initialisation level.
void load_class_documentation() noexcept;

} // namespace spidar
