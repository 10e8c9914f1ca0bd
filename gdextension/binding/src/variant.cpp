// The parts of String, Array, Dictionary, Callable and Variant that are not plain method calls.

#include <godot_cpp/classes/object.hpp>
#include <godot_cpp/internal/calls.hpp>
#include <godot_cpp/internal/error_report.hpp>

namespace godot {

namespace {

// Runs constructor `index` of a built-in type over its default value, from one argument.
void construct_from(GDExtensionVariantType type, int32_t index, GDExtensionTypePtr place,
                    const void *argument) {
    const GDExtensionPtrConstructor construct =
        internal::api.variant_get_ptr_constructor(type, index);
    if (construct != nullptr) {
        construct(place, &argument);
    }
}

} // namespace

// The default value under each of these owns nothing, so constructing over it loses nothing.

String::String(const char *text) {
    internal::api.string_new_with_latin1_chars(_native_ptr(), text == nullptr ? "" : text);
}

String::String(const StringName &name) {
    construct_from(GDEXTENSION_VARIANT_TYPE_STRING, 2, _native_ptr(), name._native_ptr());
}

String::String(const NodePath &path) {
    construct_from(GDEXTENSION_VARIANT_TYPE_STRING, 3, _native_ptr(), path._native_ptr());
}

String String::utf8(const char *text, int64_t length) {
    String made;
    if (length < 0) {
        internal::api.string_new_with_utf8_chars(made._native_ptr(), text);
    } else {
        internal::api.string_new_with_utf8_chars_and_len(made._native_ptr(), text, length);
    }
    return made;
}

CharString String::utf8() const {
    CharString made;
    const GDExtensionInt length = internal::api.string_to_utf8_chars(_native_ptr(), nullptr, 0);
    made.text_.resize(static_cast<std::size_t>(length));
    internal::api.string_to_utf8_chars(_native_ptr(), made.text_.data(), length);
    return made;
}

String String::operator+(const String &other) const {
    String sum = *this;
    sum += other;
    return sum;
}

String &String::operator+=(const String &other) {
    internal::api.string_operator_plus_eq_string(_native_ptr(), other._native_ptr());
    return *this;
}

bool String::operator<(const String &other) const {
    static const GDExtensionPtrOperatorEvaluator evaluate =
        internal::api.variant_get_ptr_operator_evaluator(GDEXTENSION_VARIANT_OP_LESS,
                                                         GDEXTENSION_VARIANT_TYPE_STRING,
                                                         GDEXTENSION_VARIANT_TYPE_STRING);
    GDExtensionBool result = 0;
    evaluate(_native_ptr(), other._native_ptr(), &result);
    return result != 0;
}

StringName::StringName(const char *text) {
    internal::api.string_name_new_with_latin1_chars(_native_ptr(), text == nullptr ? "" : text, 0);
}

StringName::StringName(const String &text) {
    construct_from(GDEXTENSION_VARIANT_TYPE_STRING_NAME, 2, _native_ptr(), text._native_ptr());
}

NodePath::NodePath(const String &path) {
    construct_from(GDEXTENSION_VARIANT_TYPE_NODE_PATH, 2, _native_ptr(), path._native_ptr());
}

Variant &Array::operator[](int64_t index) {
    return *static_cast<Variant *>(internal::api.array_operator_index(_native_ptr(), index));
}

const Variant &Array::operator[](int64_t index) const {
    return *static_cast<const Variant *>(
        internal::api.array_operator_index_const(_native_ptr(), index));
}

Variant &Dictionary::operator[](const Variant &key) {
    return *static_cast<Variant *>(
        internal::api.dictionary_operator_index(_native_ptr(), key._native_ptr()));
}

const Variant &Dictionary::operator[](const Variant &key) const {
    return *static_cast<const Variant *>(
        internal::api.dictionary_operator_index_const(_native_ptr(), key._native_ptr()));
}

Callable::Callable(const Object *object, const StringName &method) {
    const GDExtensionPtrConstructor construct =
        internal::api.variant_get_ptr_constructor(GDEXTENSION_VARIANT_TYPE_CALLABLE, 2);
    GodotObject *owner = object == nullptr ? nullptr : object->_owner;
    const GDExtensionConstTypePtr arguments[] = {&owner, method._native_ptr()};
    construct(_native_ptr(), arguments);
}

Variant::Variant(const Object *object) {
    GodotObject *owner = object == nullptr ? nullptr : object->_owner;
    fill(GDEXTENSION_VARIANT_TYPE_OBJECT, &owner);
}

Variant::operator Object *() const {
    if (get_type() != OBJECT) {
        return nullptr;
    }
    // By id, not by pointer: the object may have been freed since.
    const GDObjectInstanceID id = internal::api.variant_get_object_instance_id(bytes_.data());
    GodotObject *owner = id == 0 ? nullptr : internal::api.object_get_instance_from_id(id);
    return static_cast<Object *>(internal::wrap(owner));
}

String Variant::stringify() const {
    String text;
    internal::api.variant_stringify(bytes_.data(), text._native_ptr());
    return text;
}

bool Variant::operator==(const Variant &other) const {
    if (get_type() != other.get_type()) {
        return false;
    }
    Variant result;
    GDExtensionBool valid = 0;
    internal::api.variant_evaluate(GDEXTENSION_VARIANT_OP_EQUAL, bytes_.data(), other.bytes_.data(),
                                   result._native_ptr(), &valid);
    return valid != 0 && result.booleanize();
}

String Variant::get_type_name(Type type) {
    String name;
    internal::api.variant_get_type_name(static_cast<GDExtensionVariantType>(type),
                                        name._native_ptr());
    return name;
}

bool Variant::can_convert_strict(Type from, Type to) {
    return internal::api.variant_can_convert_strict(static_cast<GDExtensionVariantType>(from),
                                                    static_cast<GDExtensionVariantType>(to)) != 0;
}

namespace internal {

String format(const String &text, const Array &values) {
    static const GDExtensionPtrOperatorEvaluator evaluate = api.variant_get_ptr_operator_evaluator(
        GDEXTENSION_VARIANT_OP_MODULE, GDEXTENSION_VARIANT_TYPE_STRING,
        GDEXTENSION_VARIANT_TYPE_ARRAY);
    String result;
    evaluate(text._native_ptr(), values._native_ptr(), result._native_ptr());
    return result;
}

void report(const char *function, const char *file, int line, const String &condition,
            const String &message) {
    report_error(function, file, line, condition.utf8().get_data(), message.utf8().get_data());
}

void warn(const char *function, const char *file, int line, const String &message) {
    report_warning(function, file, line, message.utf8().get_data());
}

} // namespace internal
} // namespace godot
