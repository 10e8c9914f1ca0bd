#include "godot/base/strict.h"

namespace spidar {

namespace {

// Longest value in a message: enough for a transform, but not a whole array.
constexpr std::int64_t kLongestValue = 100;

} // namespace

std::string describe_value(const godot::Variant &value) {
    using godot::Variant;
    const Variant::Type type = value.get_type();
    if (type == Variant::NIL) {
        return "null";
    }
    godot::String text = value.stringify();
    if (text.length() > kLongestValue) {
        text = text.substr(0, kLongestValue);
        text += godot::String("...");
    }
    std::string shown = text.utf8().get_data();
    if (type == Variant::STRING || type == Variant::STRING_NAME || type == Variant::NODE_PATH) {
        shown = "\"" + shown + "\"";
    }
    return shown + " (" + Variant::get_type_name(type).utf8().get_data() + ")";
}

namespace strict {

bool all_numbers(const godot::Array &values) {
    for (std::int64_t i = 0; i < values.size(); ++i) {
        if (!is_number(values[i])) {
            return false;
        }
    }
    return true;
}

bool all_int32(const godot::Array &values) {
    for (std::int64_t i = 0; i < values.size(); ++i) {
        std::int32_t value = 0;
        if (!take(values[i], value)) {
            return false;
        }
    }
    return true;
}

bool all_vectors(const godot::Array &values) {
    for (std::int64_t i = 0; i < values.size(); ++i) {
        if (values[i].get_type() != godot::Variant::VECTOR3) {
            return false;
        }
    }
    return true;
}

std::string name_of(std::string_view method, std::string_view argument, bool is_setter) {
    constexpr std::string_view kSet = "set_";
    if (is_setter && method.substr(0, kSet.size()) == kSet) {
        return std::string(method.substr(kSet.size()));
    }
    return std::string(method) + ": " + std::string(argument);
}

std::string unit_of(std::string_view hint) {
    constexpr std::string_view kSuffix = "suffix:";
    const std::size_t at = hint.find(kSuffix);
    if (at != std::string_view::npos) {
        const std::string_view unit = hint.substr(at + kSuffix.size());
        return " in " + std::string(unit.substr(0, unit.find(',')));
    }
    return hint.find("radians") != std::string_view::npos ? " in rad" : "";
}

} // namespace strict
} // namespace spidar
