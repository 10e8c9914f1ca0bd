// Checks the types of the arguments that scripts pass to bound methods. Without this check, a
// binding may convert an argument to the method's type: the text "off" becomes true, null becomes a
// force of zero. Such a conversion is unsafe where motors can move. Strict<T> keeps a text on an
// argument whose type does not fit T.
#pragma once

#include <cmath>
#include <cstdint>
#include <limits>
#include <string>
#include <string_view>
#include <type_traits>

#include <godot_cpp/classes/ref.hpp>
#include <godot_cpp/core/binder_common.hpp>
#include <godot_cpp/core/class_db.hpp>
#include <godot_cpp/variant/array.hpp>
#include <godot_cpp/variant/packed_float64_array.hpp>
#include <godot_cpp/variant/packed_int32_array.hpp>
#include <godot_cpp/variant/packed_vector3_array.hpp>
#include <godot_cpp/variant/string.hpp>
#include <godot_cpp/variant/transform3d.hpp>
#include <godot_cpp/variant/variant.hpp>
#include <godot_cpp/variant/vector3.hpp>

namespace spidar {

template <class T>
struct Strict {
    using BoundAs = T;
    T value{};
    // Empty if the argument fits, else the passed value and its type.
    std::string misfit;
};

// Returns a text for messages: the value, cut after 100 characters, and its type.
[[nodiscard]] std::string describe_value(const godot::Variant &value);

namespace strict {

template <class T>
struct IsRef : std::false_type {};
template <class T>
struct IsRef<godot::Ref<T>> : std::true_type {
    using Class = T;
};

template <class T>
inline constexpr bool kWhole = std::is_enum_v<T> ||
                               (std::is_integral_v<T> && !std::is_same_v<T, bool>);

template <class T>
[[nodiscard]] bool take_whole(std::int64_t given, T &value) {
    // Enums are passed as 32 bits: the method checks which of the values it knows.
    using Narrow = std::conditional_t<std::is_enum_v<T>, std::int32_t, T>;
    if (given < static_cast<std::int64_t>(std::numeric_limits<Narrow>::min()) ||
        given > static_cast<std::int64_t>(std::numeric_limits<Narrow>::max())) {
        return false;
    }
    value = static_cast<T>(given);
    return true;
}

// True for int and float.
[[nodiscard]] inline bool is_number(const godot::Variant &value) {
    return value.get_type() == godot::Variant::INT || value.get_type() == godot::Variant::FLOAT;
}
[[nodiscard]] bool all_numbers(const godot::Array &values);
// True if all values are whole numbers (int or float) that fit into 32 bits.
[[nodiscard]] bool all_int32(const godot::Array &values);
[[nodiscard]] bool all_vectors(const godot::Array &values);

// Sets `value` and returns true if the type of `given` fits T; else returns false.
template <class T>
[[nodiscard]] bool take(const godot::Variant &given, T &value) {
    using godot::Variant;
    const Variant::Type type = given.get_type();
    if constexpr (std::is_same_v<T, bool>) {
        if (type == Variant::BOOL) {
            value = given.booleanize();
            return true;
        }
        return false;
    } else if constexpr (kWhole<T>) {
        if (type == Variant::INT) {
            return take_whole(static_cast<std::int64_t>(given), value);
        }
        constexpr double kExact = 9007199254740992.0; // 2^53
        const double real = type == Variant::FLOAT ? static_cast<double>(given) : 0.5;
        return std::abs(real) <= kExact && real == std::floor(real) &&
               take_whole(static_cast<std::int64_t>(real), value);
    } else if constexpr (std::is_floating_point_v<T>) {
        if (is_number(given)) {
            value = static_cast<T>(static_cast<double>(given));
            return true;
        }
        return false;
    } else if constexpr (std::is_same_v<T, godot::String>) {
        if (type == Variant::STRING || type == Variant::STRING_NAME) {
            value = static_cast<godot::String>(given);
            return true;
        }
        return false;
    } else if constexpr (std::is_same_v<T, godot::PackedFloat64Array>) {
        const bool fits = type == Variant::PACKED_FLOAT64_ARRAY ||
                          (type == Variant::ARRAY && all_numbers(static_cast<godot::Array>(given)));
        if (fits) {
            value = static_cast<T>(given);
        }
        return fits;
    } else if constexpr (std::is_same_v<T, godot::PackedInt32Array>) {
        const bool fits = type == Variant::PACKED_INT32_ARRAY ||
                          (type == Variant::ARRAY && all_int32(static_cast<godot::Array>(given)));
        if (fits) {
            value = static_cast<T>(given);
        }
        return fits;
    } else if constexpr (std::is_same_v<T, godot::PackedVector3Array>) {
        const bool fits = type == Variant::PACKED_VECTOR3_ARRAY ||
                          (type == Variant::ARRAY && all_vectors(static_cast<godot::Array>(given)));
        if (fits) {
            value = static_cast<T>(given);
        }
        return fits;
    } else if constexpr (IsRef<T>::value) {
        if (type == Variant::NIL) {
            return true;
        }
        value = T(given);
        // A null object gives a null reference; an object of another class is refused.
        return value.is_valid() ||
               (type == Variant::OBJECT && static_cast<godot::Object *>(given) == nullptr);
    } else {
        if (static_cast<int>(type) == static_cast<int>(godot::GetTypeInfo<T>::VARIANT_TYPE)) {
            value = static_cast<T>(given);
            return true;
        }
        return false;
    }
}

// Returns the accepted type, for messages.
template <class T>
[[nodiscard]] std::string wanted() {
    using godot::Variant;
    if constexpr (std::is_same_v<T, bool>) {
        return "true or false";
    } else if constexpr (kWhole<T>) {
        return "a whole number of 32 bits";
    } else if constexpr (std::is_floating_point_v<T>) {
        return "a number";
    } else if constexpr (IsRef<T>::value) {
        return "a " +
               std::string(godot::String(IsRef<T>::Class::get_class_static()).utf8().get_data()) +
               " or null";
    } else if constexpr (std::is_same_v<T, godot::PackedFloat64Array>) {
        return "an array of numbers";
    } else if constexpr (std::is_same_v<T, godot::PackedInt32Array>) {
        return "an array of whole numbers";
    } else if constexpr (std::is_same_v<T, godot::PackedVector3Array>) {
        return "an array of Vector3";
    } else {
        const auto type = static_cast<Variant::Type>(godot::GetTypeInfo<T>::VARIANT_TYPE);
        return "a " + std::string(Variant::get_type_name(type).utf8().get_data());
    }
}

template <std::size_t kSize>
struct FixedText {
    char text[kSize]{};
    // Implicit, since a template argument is written as a literal.
    constexpr FixedText(const char (&literal)[kSize]) { // NOLINT(google-explicit-constructor)
        for (std::size_t i = 0; i < kSize; ++i) {
            text[i] = literal[i];
        }
    }
};

// Returns "forces_enabled" for the setter "set_forces_enabled", else "method: argument".
[[nodiscard]] std::string name_of(std::string_view method, std::string_view argument,
                                  bool is_setter);
// Returns " in N" for "0,40,0.1,suffix:N" and " in rad" for angles; empty if the hint has no unit.
[[nodiscard]] std::string unit_of(std::string_view hint);

template <class M>
struct Method;
template <class C, class R, class... A>
struct Method<R (C::*)(A...)> {
    using Class = C;
    using Result = R;
    template <class Call>
    static constexpr auto checked() {
        return &C::template checked<Call, R, std::remove_cvref_t<A>...>;
    }
    static constexpr bool kIsSetter = sizeof...(A) == 1 && std::is_void_v<R>;
};
template <class C, class R, class... A>
struct Method<R (C::*)(A...) const> {
    using Class = C;
    using Result = R;
    template <class Call>
    static constexpr auto checked() {
        return &C::template checked_const<Call, R, std::remove_cvref_t<A>...>;
    }
    static constexpr bool kIsSetter = false;
};

template <auto kMethod, FixedText kHint, FixedText kName, FixedText... kArguments>
struct Call {
    using Signature = Method<decltype(kMethod)>;
    using Result = typename Signature::Result;

    template <class Self, class... A>
    static Result run(Self &self, const Strict<A> &...arguments) {
        static_assert(sizeof...(A) == sizeof...(kArguments), "Name each argument.");
        const bool fits = (check(self, arguments, kArguments.text) && ...);
        if (!fits) {
            return Result();
        }
        return (self.*kMethod)(arguments.value...);
    }

private:
    template <class Self, class A>
    static bool check(Self &self, const Strict<A> &argument, const char *name) {
        if (argument.misfit.empty()) {
            return true;
        }
        self.refuse(name_of(kName.text, name, Signature::kIsSetter) + " = " + argument.misfit +
                    ": give " + wanted<A>() + unit_of(kHint.text) +
                    (Signature::kIsSetter ? "; the old value stays." : "; nothing is changed."));
        return false;
    }
};

} // namespace strict

// Binds a method whose arguments Strict checks. After a misfit the method is not called and the
// object's refuse() gets a message. The class needs SPIDAR_G_CHECKED_CALLS and a member
// refuse(const std::string &). kHint: for a setter, the hint string of its property, which holds
// the unit; else "".
template <auto kMethod, strict::FixedText kHint, strict::FixedText kName,
          strict::FixedText... kArguments, class... Defaults>
void bind_checked(const Defaults &...defaults) {
    using Call = strict::Call<kMethod, kHint, kName, kArguments...>;
    godot::ClassDB::bind_method(godot::D_METHOD(kName.text, kArguments.text...),
                                Call::Signature::template checked<Call>(), defaults...);
}

} // namespace spidar

namespace godot {

template <class T>
struct VariantCaster<spidar::Strict<T>> {
    static spidar::Strict<T> cast(const Variant &given) {
        spidar::Strict<T> argument;
        if (!spidar::strict::take(given, argument.value)) {
            argument.misfit = spidar::describe_value(given);
        }
        return argument;
    }
};

// Converts the arguments of calls from typed GDScript. The engine has checked their types already,
// but passes whole numbers as 64 bits.
template <class T>
struct PtrToArg<spidar::Strict<T>> {
    static spidar::Strict<T> convert(const void *address) {
        spidar::Strict<T> argument;
        if constexpr (spidar::strict::kWhole<T>) {
            const auto given = PtrToArg<std::int64_t>::convert(address);
            if (!spidar::strict::take_whole(given, argument.value)) {
                argument.misfit = std::to_string(given) + " (int)";
            }
        } else {
            argument.value = PtrToArg<T>::convert(address);
        }
        return argument;
    }
};

// Scripts see the method with arguments of type T. VARIANT_TYPE 0 disables the binding's own type
// check, whose message would not name the argument.
template <class T>
struct GetTypeInfo<spidar::Strict<T>> : GetTypeInfo<T> {
    static constexpr auto VARIANT_TYPE =
        static_cast<std::remove_cv_t<decltype(GetTypeInfo<T>::VARIANT_TYPE)>>(0);
};

} // namespace godot

// Placed in a class: adds the functions that bind_checked() binds in place of the class's methods.
#define SPIDAR_G_CHECKED_CALLS                                                                     \
public:                                                                                            \
    template <class Call, class Result, class... Values>                                           \
    Result checked(spidar::Strict<Values>... values) {                                             \
        return Call::run(*this, values...);                                                        \
    }                                                                                              \
    template <class Call, class Result, class... Values>                                           \
    Result checked_const(spidar::Strict<Values>... values) const {                                 \
        return Call::run(*this, values...);                                                        \
    }
