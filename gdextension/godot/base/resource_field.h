// A field of a Resource with its setter and getter: unchanged values return early, changed ones emit `changed`.
// (Written as a macro because each accessor must be a named member for ClassDB::bind_method.)
#pragma once

#define SPIDAR_G_FIELD(m_type, m_name, m_default)                                                  \
public:                                                                                            \
    void set_##m_name(m_type p_value) {                                                            \
        if (m_name##_ == p_value) {                                                                \
            return;                                                                                \
        }                                                                                          \
        m_name##_ = p_value;                                                                       \
        emit_changed();                                                                            \
    }                                                                                              \
    m_type get_##m_name() const {                                                                  \
        return m_name##_;                                                                          \
    }                                                                                              \
                                                                                                   \
private:                                                                                           \
    m_type m_name##_ = m_default

// The same for values that are handed over by reference (packed arrays, strings).
#define SPIDAR_G_ARRAY_FIELD(m_type, m_name)                                                       \
public:                                                                                            \
    void set_##m_name(const m_type &p_value) {                                                     \
        m_name##_ = p_value;                                                                       \
        emit_changed();                                                                            \
    }                                                                                              \
    m_type get_##m_name() const {                                                                  \
        return m_name##_;                                                                          \
    }                                                                                              \
                                                                                                   \
private:                                                                                           \
    m_type m_name##_

#define SPIDAR_G_BIND_FIELD(m_class, m_variant, m_name, m_hint, m_hint_string)                     \
    godot::ClassDB::bind_method(godot::D_METHOD("set_" #m_name, #m_name), &m_class::set_##m_name); \
    godot::ClassDB::bind_method(godot::D_METHOD("get_" #m_name), &m_class::get_##m_name);          \
    ADD_PROPERTY(godot::PropertyInfo(m_variant, #m_name, m_hint, m_hint_string), "set_" #m_name,   \
                 "get_" #m_name)
