#include "godot/settings/project_options.h"

#include <cmath>
#include <string>

#include <godot_cpp/classes/global_constants.hpp>
#include <godot_cpp/classes/project_settings.hpp>
#include <godot_cpp/classes/resource_loader.hpp>
#include <godot_cpp/variant/dictionary.hpp>
#include <godot_cpp/variant/string.hpp>
#include <godot_cpp/variant/utility_functions.hpp>

#include "godot/base/type_conversions.h"

using godot::ProjectSettings;
using godot::String;
using godot::Variant;

namespace spidar {

namespace {

constexpr const char *kConfig = "spidar_g/device/default_config";
constexpr const char *kHardware = "spidar_g/device/use_hardware";
constexpr const char *kMaterial = "spidar_g/hand/default_material";
constexpr const char *kForce = "spidar_g/safety/max_force";
constexpr const char *kPanicKey = "spidar_g/safety/panic_key";

void add_option(const char *name, const Variant &value, godot::PropertyHint hint,
                const String &hint_string) {
    ProjectSettings *settings = ProjectSettings::get_singleton();
    if (!settings->has_setting(name)) {
        settings->set_setting(name, value);
    }
    settings->set_initial_value(name, value);
    settings->set_as_basic(name, true);
    godot::Dictionary shown;
    shown["name"] = name;
    shown["type"] = static_cast<int>(value.get_type());
    shown["hint"] = static_cast<int>(hint);
    shown["hint_string"] = hint_string;
    settings->add_property_info(shown);
}

Variant option(const char *name) {
    return ProjectSettings::get_singleton()->get_setting(name, Variant());
}

// Returns null when the option is empty, and prints an error when it names no resource of that
// kind.
template <typename Kind>
godot::Ref<Kind> resource_of(const char *name) {
    const Variant set = option(name);
    if (set.get_type() != Variant::STRING || static_cast<String>(set).is_empty()) {
        return {};
    }
    const String path(set);
    const godot::Ref<Kind> resource(Variant(godot::ResourceLoader::get_singleton()->load(path)));
    if (resource.is_null()) {
        godot::UtilityFunctions::push_error(
            String("Project setting ") + String(name) + String(" = \"") + path +
            String("\" is not a ") + String(Kind::get_class_static()) +
            String(": choose a resource of that class, or clear the setting."));
    }
    return resource;
}

std::string key_choices() {
    const auto choice = [](const char *name, godot::Key key) {
        return std::string(",") + name + ":" + std::to_string(static_cast<int>(key));
    };
    return "None:0" + choice("Space", godot::KEY_SPACE) + choice("Escape", godot::KEY_ESCAPE) +
           choice("Backspace", godot::KEY_BACKSPACE) + choice("Pause", godot::KEY_PAUSE) +
           choice("F9", godot::KEY_F9) + choice("F12", godot::KEY_F12);
}

} // namespace

void register_project_options() {
    const ProjectOptions standard;
    add_option(kConfig, String(), godot::PROPERTY_HINT_FILE, "*.tres,*.res");
    add_option(kMaterial, String(), godot::PROPERTY_HINT_FILE, "*.tres,*.res");
    add_option(kHardware, standard.use_hardware, godot::PROPERTY_HINT_NONE, "");
    add_option(kForce, standard.largest_force_n, godot::PROPERTY_HINT_RANGE, "0.1,40,0.1,suffix:N");
    add_option(kPanicKey, standard.panic_key, godot::PROPERTY_HINT_ENUM, to_godot(key_choices()));
}

ProjectOptions project_options() {
    ProjectOptions options;
    const Variant hardware = option(kHardware);
    if (hardware.get_type() == Variant::BOOL) {
        options.use_hardware = hardware.booleanize();
    }
    const Variant force = option(kForce);
    if (force.get_type() == Variant::FLOAT || force.get_type() == Variant::INT) {
        const double force_n = static_cast<double>(force);
        if (force_n > 0.0 && std::isfinite(force_n)) {
            options.largest_force_n = force_n;
        }
    }
    const Variant key = option(kPanicKey);
    if (key.get_type() == Variant::INT) {
        options.panic_key = static_cast<int>(static_cast<std::int64_t>(key));
    }
    return options;
}

godot::Ref<SpidarGConfig> project_config() {
    return resource_of<SpidarGConfig>(kConfig);
}

godot::Ref<SpidarGMaterial> project_material() {
    return resource_of<SpidarGMaterial>(kMaterial);
}

} // namespace spidar
