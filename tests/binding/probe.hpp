#pragma once

// Classes that use every part of the binding once, for the tests of project/. They include and name
// only what real godot-cpp has too.

#include <godot_cpp/classes/node3d.hpp>
#include <godot_cpp/classes/ref.hpp>
#include <godot_cpp/classes/resource.hpp>
#include <godot_cpp/core/binder_common.hpp>
#include <godot_cpp/core/class_db.hpp>
#include <godot_cpp/variant/dictionary.hpp>
#include <godot_cpp/variant/packed_float64_array.hpp>
#include <godot_cpp/variant/packed_int32_array.hpp>
#include <godot_cpp/variant/packed_string_array.hpp>
#include <godot_cpp/variant/packed_vector3_array.hpp>

namespace probe {

class ProbeConfig : public godot::Resource {
    GDCLASS(ProbeConfig, godot::Resource)

public:
    void set_rate_hz(double rate_hz);
    double get_rate_hz() const { return rate_hz_; }
    void set_lengths(const godot::PackedFloat64Array &lengths) { lengths_ = lengths; }
    godot::PackedFloat64Array get_lengths() const { return lengths_; }

protected:
    static void _bind_methods();

private:
    double rate_hz_ = 1000.0;
    godot::PackedFloat64Array lengths_;
};

class ProbeCounter : public godot::RefCounted {
    GDCLASS(ProbeCounter, godot::RefCounted)

public:
    ProbeCounter() { ++alive_; }
    ~ProbeCounter() override { --alive_; }
    int add(int amount) { return total_ += amount; }
    static int64_t get_alive() { return alive_; }
    static godot::Ref<ProbeCounter> make(int start);

protected:
    static void _bind_methods();

private:
    int total_ = 0;
    static inline int64_t alive_ = 0;
};

class Probe : public godot::Node3D {
    GDCLASS(Probe, godot::Node3D)

public:
    enum Mode { MODE_IDLE, MODE_ACTIVE = 4, MODE_FAULT };
    static constexpr int kStrings = 8;

    Probe();

    void _ready() override;
    void _process(double delta) override;
    godot::PackedStringArray _get_configuration_warnings() const override;

    void set_config(const godot::Ref<ProbeConfig> &config);
    godot::Ref<ProbeConfig> get_config() const { return config_; }
    void set_mode(Mode mode);
    Mode get_mode() const { return mode_; }
    void set_gain(float gain) { gain_ = gain; }
    float get_gain() const { return gain_; }

    double sum(double a, double b, int c) const { return a + b + c; }
    bool flip(bool value) const { return !value; }
    int32_t small(int32_t value) const { return value; }
    uint8_t byte(uint8_t value) const { return value; }
    godot::Variant echo(const godot::Variant &value) const { return value; }
    godot::String describe(const godot::String &name, const godot::StringName &unit) const;
    godot::Dictionary statistics() const;
    godot::Array list(int64_t count) const;
    godot::PackedFloat64Array doubled(const godot::PackedFloat64Array &values) const;
    godot::PackedVector3Array mirrored(const godot::PackedVector3Array &points) const;
    godot::PackedInt32Array counted(int32_t count) const;
    godot::Transform3D product(const godot::Transform3D &a, const godot::Transform3D &b) const;
    godot::Dictionary rotation_facts(const godot::Basis &basis) const;
    godot::Quaternion turned(const godot::Quaternion &q, const godot::Vector3 &axis,
                             double angle_rad) const;
    godot::Node *first_child() const;
    godot::Object *same(godot::Object *object) const { return object; }
    bool is_probe(godot::Object *object) const;
    int64_t owners_of_duplicate() const;
    int64_t call_count_of(const godot::Ref<ProbeCounter> &counter) const;
    godot::Ref<ProbeCounter> make_counter(int start) const { return ProbeCounter::make(start); }
    godot::Error emit_many();
    int64_t connect_own(bool connected);
    void on_many(int64_t a, double b, const godot::String &c);
    int64_t get_heard() const { return heard_; }
    godot::Dictionary engine_facts() const;
    godot::Dictionary text_facts() const;
    int64_t check_index(int64_t index) const;
    void make_child(const godot::String &name);
    godot::PackedStringArray get_log() const { return log_; }
    static godot::String version_text(int64_t major, int64_t minor);

protected:
    static void _bind_methods();
    void _notification(int what);
    bool _set(const godot::StringName &name, const godot::Variant &value);
    bool _get(const godot::StringName &name, godot::Variant &value) const;
    void _validate_property(godot::PropertyInfo &property) const;
    godot::String _to_string() const;

    void note(const godot::String &entry) { log_.push_back(entry); }

private:
    godot::Ref<ProbeConfig> config_;
    Mode mode_ = MODE_IDLE;
    float gain_ = 0.5F;
    int64_t heard_ = 0;
    int64_t hidden_value_ = 7;
    double time_s_ = 0;
    godot::PackedStringArray log_;
};

// A second level: inherits Probe's methods and hooks, adds its own.
class DerivedProbe : public Probe {
    GDCLASS(DerivedProbe, Probe)

public:
    void _physics_process(double delta) override;
    int64_t get_ticks() const { return ticks_; }

protected:
    static void _bind_methods();
    void _notification(int what);

private:
    int64_t ticks_ = 0;
};

} // namespace probe

VARIANT_ENUM_CAST(probe::Probe::Mode);
