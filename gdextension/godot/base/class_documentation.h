// Passes the class reference (gdextension/doc_classes/*.xml, compiled in) to the editor's help.
#pragma once

#include <gdextension_interface.h>

namespace spidar {

// The XML texts of the classes. The build generates this array.
extern const char *const kClassDocumentation[];
extern const int kClassDocumentationCount;

// Called in the entry function: finds the editor's function for loading XML help. An exported game
// has none.
void prepare_class_documentation(GDExtensionInterfaceGetProcAddress get_proc_address) noexcept;
// Called at the editor's initialization level: loads the texts.
void load_class_documentation() noexcept;

} // namespace spidar
