#pragma once

// Macros that print an error or a warning with function, file and line. The ERR_FAIL macros then
// return from the function. The _MSG forms take a String or a literal in ASCII.

#include <godot_cpp/internal/error_report.hpp>

#define GODOT_BINDING_REPORT(m_text, m_message)                                                    \
    ::godot::internal::report(__func__, __FILE__, __LINE__, m_text, m_message)
#define GODOT_BINDING_FAIL(m_condition, m_text, m_message, m_return)                               \
    do {                                                                                           \
        if (m_condition) [[unlikely]] {                                                            \
            GODOT_BINDING_REPORT(m_text, m_message);                                               \
            m_return;                                                                              \
        }                                                                                          \
    } while (false)
#define GODOT_BINDING_OUTSIDE(m_index, m_size)                                                     \
    ::godot::internal::is_outside(static_cast<int64_t>(m_index), static_cast<int64_t>(m_size))

#define ERR_FAIL_COND(m_condition) ERR_FAIL_COND_MSG(m_condition, "")
#define ERR_FAIL_COND_MSG(m_condition, m_message)                                                  \
    GODOT_BINDING_FAIL(m_condition, "Condition \"" #m_condition "\" is true.", m_message, return )
#define ERR_FAIL_COND_V(m_condition, m_value) ERR_FAIL_COND_V_MSG(m_condition, m_value, "")
#define ERR_FAIL_COND_V_MSG(m_condition, m_value, m_message)                                       \
    GODOT_BINDING_FAIL(m_condition,                                                                \
                       "Condition \"" #m_condition "\" is true. Returning: " #m_value, m_message,  \
                       return m_value)

#define ERR_FAIL() ERR_FAIL_MSG("")
#define ERR_FAIL_MSG(m_message)                                                                    \
    GODOT_BINDING_FAIL(true, "Method/function failed.", m_message, return )
#define ERR_FAIL_V(m_value) ERR_FAIL_V_MSG(m_value, "")
#define ERR_FAIL_V_MSG(m_value, m_message)                                                         \
    GODOT_BINDING_FAIL(true, "Method/function failed. Returning: " #m_value, m_message,            \
                       return m_value)

#define ERR_FAIL_NULL(m_pointer) ERR_FAIL_NULL_MSG(m_pointer, "")
#define ERR_FAIL_NULL_MSG(m_pointer, m_message)                                                    \
    GODOT_BINDING_FAIL((m_pointer) == nullptr, "Parameter \"" #m_pointer "\" is null.", m_message, \
                       return )
#define ERR_FAIL_NULL_V(m_pointer, m_value) ERR_FAIL_NULL_V_MSG(m_pointer, m_value, "")
#define ERR_FAIL_NULL_V_MSG(m_pointer, m_value, m_message)                                         \
    GODOT_BINDING_FAIL((m_pointer) == nullptr, "Parameter \"" #m_pointer "\" is null.", m_message, \
                       return m_value)

#define ERR_FAIL_INDEX(m_index, m_size) ERR_FAIL_INDEX_MSG(m_index, m_size, "")
#define ERR_FAIL_INDEX_MSG(m_index, m_size, m_message)                                             \
    GODOT_BINDING_FAIL(GODOT_BINDING_OUTSIDE(m_index, m_size),                                     \
                       "Index " #m_index " is out of bounds (0 to " #m_size " - 1).", m_message,   \
                       return )
#define ERR_FAIL_INDEX_V(m_index, m_size, m_value)                                                 \
    ERR_FAIL_INDEX_V_MSG(m_index, m_size, m_value, "")
#define ERR_FAIL_INDEX_V_MSG(m_index, m_size, m_value, m_message)                                  \
    GODOT_BINDING_FAIL(GODOT_BINDING_OUTSIDE(m_index, m_size),                                     \
                       "Index " #m_index " is out of bounds (0 to " #m_size " - 1).", m_message,   \
                       return m_value)

#define ERR_PRINT(m_message) GODOT_BINDING_REPORT(m_message, "")
#define WARN_PRINT(m_message) ::godot::internal::warn(__func__, __FILE__, __LINE__, m_message)
