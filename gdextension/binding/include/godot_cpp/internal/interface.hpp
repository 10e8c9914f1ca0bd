#pragma once

// Not part of the godot-cpp API: the table of engine functions that this binding calls.

#include <godot_cpp/core/defs.hpp>

// X(name in the engine, name of the type in gdextension_interface.h). All exist since Godot 4.4,
// and load_interface() fails if one is missing.
#define GODOT_BINDING_FUNCTIONS(X)                                                                 \
    X(print_error, PrintError)                                                                     \
    X(print_error_with_message, PrintErrorWithMessage)                                             \
    X(print_warning, PrintWarning)                                                                 \
    X(variant_new_copy, VariantNewCopy)                                                            \
    X(variant_new_nil, VariantNewNil)                                                              \
    X(variant_destroy, VariantDestroy)                                                             \
    X(variant_evaluate, VariantEvaluate)                                                           \
    X(variant_booleanize, VariantBooleanize)                                                       \
    X(variant_stringify, VariantStringify)                                                         \
    X(variant_get_type, VariantGetType)                                                            \
    X(variant_get_type_name, VariantGetTypeName)                                                   \
    X(variant_get_object_instance_id, VariantGetObjectInstanceId)                                  \
    X(variant_can_convert_strict, VariantCanConvertStrict)                                         \
    X(get_variant_from_type_constructor, GetVariantFromTypeConstructor)                            \
    X(get_variant_to_type_constructor, GetVariantToTypeConstructor)                                \
    X(variant_get_ptr_operator_evaluator, VariantGetPtrOperatorEvaluator)                          \
    X(variant_get_ptr_builtin_method, VariantGetPtrBuiltinMethod)                                  \
    X(variant_get_ptr_constructor, VariantGetPtrConstructor)                                       \
    X(variant_get_ptr_destructor, VariantGetPtrDestructor)                                         \
    X(variant_get_ptr_utility_function, VariantGetPtrUtilityFunction)                              \
    X(string_new_with_latin1_chars, StringNewWithLatin1Chars)                                      \
    X(string_new_with_utf8_chars, StringNewWithUtf8Chars)                                          \
    X(string_new_with_utf8_chars_and_len, StringNewWithUtf8CharsAndLen)                            \
    X(string_to_utf8_chars, StringToUtf8Chars)                                                     \
    X(string_operator_plus_eq_string, StringOperatorPlusEqString)                                  \
    X(string_name_new_with_latin1_chars, StringNameNewWithLatin1Chars)                             \
    X(packed_byte_array_operator_index, PackedByteArrayOperatorIndex)                              \
    X(packed_byte_array_operator_index_const, PackedByteArrayOperatorIndexConst)                   \
    X(packed_int32_array_operator_index, PackedInt32ArrayOperatorIndex)                            \
    X(packed_int32_array_operator_index_const, PackedInt32ArrayOperatorIndexConst)                 \
    X(packed_int64_array_operator_index, PackedInt64ArrayOperatorIndex)                            \
    X(packed_int64_array_operator_index_const, PackedInt64ArrayOperatorIndexConst)                 \
    X(packed_float32_array_operator_index, PackedFloat32ArrayOperatorIndex)                        \
    X(packed_float32_array_operator_index_const, PackedFloat32ArrayOperatorIndexConst)             \
    X(packed_float64_array_operator_index, PackedFloat64ArrayOperatorIndex)                        \
    X(packed_float64_array_operator_index_const, PackedFloat64ArrayOperatorIndexConst)             \
    X(packed_string_array_operator_index, PackedStringArrayOperatorIndex)                          \
    X(packed_string_array_operator_index_const, PackedStringArrayOperatorIndexConst)               \
    X(packed_vector2_array_operator_index, PackedVector2ArrayOperatorIndex)                        \
    X(packed_vector2_array_operator_index_const, PackedVector2ArrayOperatorIndexConst)             \
    X(packed_vector3_array_operator_index, PackedVector3ArrayOperatorIndex)                        \
    X(packed_vector3_array_operator_index_const, PackedVector3ArrayOperatorIndexConst)             \
    X(array_operator_index, ArrayOperatorIndex)                                                    \
    X(array_operator_index_const, ArrayOperatorIndexConst)                                         \
    X(dictionary_operator_index, DictionaryOperatorIndex)                                          \
    X(dictionary_operator_index_const, DictionaryOperatorIndexConst)                               \
    X(object_method_bind_call, ObjectMethodBindCall)                                               \
    X(object_method_bind_ptrcall, ObjectMethodBindPtrcall)                                         \
    X(object_destroy, ObjectDestroy)                                                               \
    X(object_get_instance_binding, ObjectGetInstanceBinding)                                       \
    X(object_free_instance_binding, ObjectFreeInstanceBinding)                                     \
    X(object_set_instance_binding, ObjectSetInstanceBinding)                                       \
    X(object_set_instance, ObjectSetInstance)                                                      \
    X(object_cast_to, ObjectCastTo)                                                                \
    X(object_get_instance_from_id, ObjectGetInstanceFromId)                                        \
    X(object_get_instance_id, ObjectGetInstanceId)                                                 \
    X(global_get_singleton, GlobalGetSingleton)                                                    \
    X(ref_get_object, RefGetObject)                                                                \
    X(ref_set_object, RefSetObject)                                                                \
    X(callable_custom_create2, CallableCustomCreate2)                                              \
    X(worker_thread_pool_add_native_task, WorkerThreadPoolAddNativeTask)                           \
    X(classdb_construct_object2, ClassdbConstructObject2)                                          \
    X(classdb_get_method_bind, ClassdbGetMethodBind)                                               \
    X(classdb_get_class_tag, ClassdbGetClassTag)                                                   \
    X(classdb_register_extension_class4, ClassdbRegisterExtensionClass4)                           \
    X(classdb_register_extension_class_method, ClassdbRegisterExtensionClassMethod)                \
    X(classdb_register_extension_class_integer_constant,                                           \
      ClassdbRegisterExtensionClassIntegerConstant)                                                \
    X(classdb_register_extension_class_property, ClassdbRegisterExtensionClassProperty)            \
    X(classdb_register_extension_class_property_group, ClassdbRegisterExtensionClassPropertyGroup) \
    X(classdb_register_extension_class_property_subgroup,                                          \
      ClassdbRegisterExtensionClassPropertySubgroup)                                               \
    X(classdb_register_extension_class_signal, ClassdbRegisterExtensionClassSignal)                \
    X(classdb_unregister_extension_class, ClassdbUnregisterExtensionClass)

namespace godot {
class StringName;
}

namespace godot::internal {

struct Interface {
#define GODOT_BINDING_MEMBER(name, type) GDExtensionInterface##type name = nullptr;
    GODOT_BINDING_FUNCTIONS(GODOT_BINDING_MEMBER)
#undef GODOT_BINDING_MEMBER
};

// The engine's functions that make, copy, destroy and convert values of one built-in type.
struct Lifecycle {
    GDExtensionPtrConstructor construct = nullptr;
    GDExtensionPtrConstructor copy = nullptr;
    GDExtensionPtrDestructor destroy = nullptr;
    GDExtensionVariantFromTypeConstructorFunc to_variant = nullptr;
    GDExtensionTypeFromVariantConstructorFunc from_variant = nullptr;
};

extern Interface api;
extern GDExtensionClassLibraryPtr library;
extern Lifecycle lifecycles[GDEXTENSION_VARIANT_TYPE_VARIANT_MAX];

// Sets `api`, `library` and `lifecycles`. Returns false and prints the reason when this Godot is
// older than the API from which the library was built, or lacks a function of the table.
bool load_interface(GDExtensionInterfaceGetProcAddress get_proc_address,
                    GDExtensionClassLibraryPtr class_library);

// Returns a StringName that lives until release_persistent_names(). text: a string literal.
const StringName &persistent_name(const char *text);
void release_persistent_names();

void report_error(const char *function, const char *file, int line, const char *condition,
                  const char *message);
void report_warning(const char *function, const char *file, int line, const char *message);

} // namespace godot::internal
