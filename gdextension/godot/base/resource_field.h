// Macros for fields of a Resource. Each defines a member with setter and getter. The setter emits
// `changed`. They are macros because ClassDB::bind_method needs named members.
#pragma once

#include <cstdint>

#include "godot/base/strict.h"

// Placed in the class before its fields. revision() counts the changes after which an open device
// must be opened again.
#define SPIDAR_G_REVISION                                                                          \
public:                                                                                            \
    [[nodiscard]] std::uint64_t revision() const noexcept {                                        \
        return revision_;                                                                          \
    }                                                                                              \
                                                                                                   \
private:                                                                                           \
    std::uint64_t revision_ = 0

// A field whose setter ignores an unchanged value. m_counts: added to revision() by a change.
#define SPIDAR_G_ANY_FIELD(m_type, m_name, m_default, m_counts)                                    \
public:                                                                                            \
    void set_##m_name(m_type p_value) {                                                            \
        if (m_name##_ == p_value) {                                                                \
            return;                                                                                \
        }                                                                                          \
        m_name##_ = p_value;                                                                       \
        revision_ += (m_counts);                                                                   \
        emit_changed();                                                                            \
    }                                                                                              \
    m_type get_##m_name() const {                                                                  \
        return m_name##_;                                                                          \
    }                                                                                              \
                                                                                                   \
private:                                                                                           \
    m_type m_name##_ = m_default

// A field after whose change the device must be opened again.
#define SPIDAR_G_FIELD(m_type, m_name, m_default) SPIDAR_G_ANY_FIELD(m_type, m_name, m_default, 1U)
// A field whose change applies while the device stays open.
#define SPIDAR_G_LIVE_FIELD(m_type, m_name, m_default)                                             \
    SPIDAR_G_ANY_FIELD(m_type, m_name, m_default, 0U)

// A field that is passed by reference (packed arrays, strings). Setting it counts as a change even
// if the value is the same; the device must be opened again.
#define SPIDAR_G_ARRAY_FIELD(m_type, m_name)                                                       \
public:                                                                                            \
    void set_##m_name(const m_type &p_value) {                                                     \
        m_name##_ = p_value;                                                                       \
        ++revision_;                                                                               \
        emit_changed();                                                                            \
    }                                                                                              \
    m_type get_##m_name() const {                                                                  \
        return m_name##_;                                                                          \
    }                                                                                              \
                                                                                                   \
private:                                                                                           \
    m_type m_name##_

#define SPIDAR_G_BIND_FIELD(m_class, m_variant, m_name, m_hint, m_hint_string)                     \
    spidar::bind_checked<&m_class::set_##m_name, m_hint_string, "set_" #m_name, #m_name>();        \
    godot::ClassDB::bind_method(godot::D_METHOD("get_" #m_name), &m_class::get_##m_name);          \
    ADD_PROPERTY(godot::PropertyInfo(m_variant, #m_name, m_hint, m_hint_string), "set_" #m_name,   \
                 "get_" #m_name)
