#pragma once

// The class reference, compiled into the library by class_docs.py. Works with both bindings.

#include <gdextension_interface.h>

namespace spidar {

// In the entry function.
void fetch_class_docs_loader(GDExtensionInterfaceGetProcAddress get_proc_address);

// At MODULE_INITIALIZATION_LEVEL_EDITOR. Nothing happens in a Godot without an editor.
void load_class_docs();

} // namespace spidar
