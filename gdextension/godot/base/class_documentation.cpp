#include "godot/base/class_documentation.h"

namespace spidar {

namespace {

// Spelled out here because the name of Godot's own typedef differs between its headers.
using LoadXml = void (*)(const char *text);
LoadXml load_xml = nullptr;

} // namespace

void prepare_class_documentation(GDExtensionInterfaceGetProcAddress get_proc_address) noexcept {
    load_xml = reinterpret_cast<LoadXml>(get_proc_address("editor_help_load_xml_from_utf8_chars"));
}

void load_class_documentation() noexcept {
    if (load_xml == nullptr) {
        return; // an exported game has no help
    }
    for (int i = 0; i < kClassDocumentationCount; ++i) {
        load_xml(kClassDocumentation[i]);
    }
}

} // namespace spidar
