#include "probe.hpp"

#include <godot_cpp/classes/engine.hpp>
#include <godot_cpp/classes/os.hpp>
#include <godot_cpp/classes/project_settings.hpp>
#include <godot_cpp/core/error_macros.hpp>
#include <godot_cpp/variant/callable_method_pointer.hpp>
#include <godot_cpp/variant/utility_functions.hpp>

using namespace godot;

namespace probe {

void ProbeConfig::_bind_methods() {
    ClassDB::bind_method(D_METHOD("set_rate_hz", "rate_hz"), &ProbeConfig::set_rate_hz);
    ClassDB::bind_method(D_METHOD("get_rate_hz"), &ProbeConfig::get_rate_hz);
    ClassDB::bind_method(D_METHOD("set_lengths", "lengths"), &ProbeConfig::set_lengths);
    ClassDB::bind_method(D_METHOD("get_lengths"), &ProbeConfig::get_lengths);
    ADD_PROPERTY(
        PropertyInfo(Variant::FLOAT, "rate_hz", PROPERTY_HINT_RANGE, "100,4000,1,suffix:Hz"),
        "set_rate_hz", "get_rate_hz");
    ADD_PROPERTY(PropertyInfo(Variant::PACKED_FLOAT64_ARRAY, "lengths"), "set_lengths",
                 "get_lengths");
}

void ProbeConfig::set_rate_hz(double rate_hz) {
    ERR_FAIL_COND_MSG(!(rate_hz > 0.0), vformat("rate_hz is %s Hz: it must be above 0.", rate_hz));
    rate_hz_ = rate_hz;
    emit_changed();
}

void ProbeCounter::_bind_methods() {
    ClassDB::bind_method(D_METHOD("add", "amount"), &ProbeCounter::add, DEFVAL(1));
    ClassDB::bind_static_method("ProbeCounter", D_METHOD("get_alive"), &ProbeCounter::get_alive);
    ClassDB::bind_static_method("ProbeCounter", D_METHOD("make", "start"), &ProbeCounter::make);
}

Ref<ProbeCounter> ProbeCounter::make(int start) {
    Ref<ProbeCounter> made;
    made.instantiate();
    made->add(start);
    return made;
}

void Probe::_bind_methods() {
    ClassDB::bind_method(D_METHOD("set_config", "config"), &Probe::set_config);
    ClassDB::bind_method(D_METHOD("get_config"), &Probe::get_config);
    ClassDB::bind_method(D_METHOD("set_mode", "mode"), &Probe::set_mode);
    ClassDB::bind_method(D_METHOD("get_mode"), &Probe::get_mode);
    ClassDB::bind_method(D_METHOD("set_gain", "gain"), &Probe::set_gain);
    ClassDB::bind_method(D_METHOD("get_gain"), &Probe::get_gain);
    ClassDB::bind_method(D_METHOD("sum", "a", "b", "c"), &Probe::sum, DEFVAL(10.0), DEFVAL(100));
    ClassDB::bind_method(D_METHOD("flip", "value"), &Probe::flip);
    ClassDB::bind_method(D_METHOD("small", "value"), &Probe::small);
    ClassDB::bind_method(D_METHOD("byte", "value"), &Probe::byte);
    ClassDB::bind_method(D_METHOD("echo", "value"), &Probe::echo);
    ClassDB::bind_method(D_METHOD("describe", "name", "unit"), &Probe::describe);
    ClassDB::bind_method(D_METHOD("statistics"), &Probe::statistics);
    ClassDB::bind_method(D_METHOD("list", "count"), &Probe::list);
    ClassDB::bind_method(D_METHOD("doubled", "values"), &Probe::doubled);
    ClassDB::bind_method(D_METHOD("mirrored", "points"), &Probe::mirrored);
    ClassDB::bind_method(D_METHOD("counted", "count"), &Probe::counted);
    ClassDB::bind_method(D_METHOD("product", "a", "b"), &Probe::product);
    ClassDB::bind_method(D_METHOD("rotation_facts", "basis"), &Probe::rotation_facts);
    ClassDB::bind_method(D_METHOD("turned", "q", "axis", "angle_rad"), &Probe::turned);
    ClassDB::bind_method(D_METHOD("first_child"), &Probe::first_child);
    ClassDB::bind_method(D_METHOD("same", "object"), &Probe::same);
    ClassDB::bind_method(D_METHOD("is_probe", "object"), &Probe::is_probe);
    ClassDB::bind_method(D_METHOD("call_count_of", "counter"), &Probe::call_count_of);
    ClassDB::bind_method(D_METHOD("owners_of_duplicate"), &Probe::owners_of_duplicate);
    ClassDB::bind_method(D_METHOD("make_counter", "start"), &Probe::make_counter);
    ClassDB::bind_method(D_METHOD("emit_many"), &Probe::emit_many);
    ClassDB::bind_method(D_METHOD("connect_own", "connected"), &Probe::connect_own);
    ClassDB::bind_method(D_METHOD("get_heard"), &Probe::get_heard);
    ClassDB::bind_method(D_METHOD("engine_facts"), &Probe::engine_facts);
    ClassDB::bind_method(D_METHOD("text_facts"), &Probe::text_facts);
    ClassDB::bind_method(D_METHOD("check_index", "index"), &Probe::check_index);
    ClassDB::bind_method(D_METHOD("make_child", "name"), &Probe::make_child);
    ClassDB::bind_method(D_METHOD("get_log"), &Probe::get_log);
    ClassDB::bind_static_method("Probe", D_METHOD("version_text", "major", "minor"),
                                &Probe::version_text, DEFVAL(0));

    ADD_GROUP("Device", "");
    ADD_PROPERTY(
        PropertyInfo(Variant::OBJECT, "config", PROPERTY_HINT_RESOURCE_TYPE, "ProbeConfig"),
        "set_config", "get_config");
    ADD_PROPERTY(PropertyInfo(Variant::INT, "mode", PROPERTY_HINT_ENUM, "Idle:0,Active:4,Fault:5"),
                 "set_mode", "get_mode");
    ADD_SUBGROUP("Tuning", "");
    ADD_PROPERTY(PropertyInfo(Variant::FLOAT, "gain", PROPERTY_HINT_RANGE, "0,1,0.01"), "set_gain",
                 "get_gain");

    ADD_SIGNAL(MethodInfo("many", PropertyInfo(Variant::INT, "a"),
                          PropertyInfo(Variant::FLOAT, "b"), PropertyInfo(Variant::STRING, "c")));
    ADD_SIGNAL(MethodInfo("mode_changed", PropertyInfo(Variant::INT, "mode")));

    BIND_ENUM_CONSTANT(MODE_IDLE);
    BIND_ENUM_CONSTANT(MODE_ACTIVE);
    BIND_ENUM_CONSTANT(MODE_FAULT);
    BIND_CONSTANT(kStrings);
}

Probe::Probe() {
    // The constructor may use the engine's half already.
    set_process_priority(3);
    set_name("made by constructor");
}

void Probe::_ready() {
    note("ready");
}

void Probe::_process(double delta) {
    time_s_ += delta;
}

PackedStringArray Probe::_get_configuration_warnings() const {
    PackedStringArray warnings;
    if (config_.is_null()) {
        warnings.push_back("No config: add a ProbeConfig.");
    }
    return warnings;
}

void Probe::set_config(const Ref<ProbeConfig> &config) {
    config_ = config;
    update_configuration_warnings();
}

void Probe::set_mode(Mode mode) {
    if (mode == mode_) {
        return;
    }
    mode_ = mode;
    emit_signal("mode_changed", mode);
}

String Probe::describe(const String &name, const StringName &unit) const {
    return name + String(" [") + String(unit) + String("]");
}

Dictionary Probe::statistics() const {
    Dictionary result;
    result["count"] = int64_t{12};
    result["rate_hz"] = 1000.25;
    result["ok"] = true;
    result["name"] = "probe";
    result["mode"] = mode_;
    result["where"] = Vector3(1, 2, 3);
    result["values"] = doubled(PackedFloat64Array());
    result["list"] = Array::make(1, "two", 3.5);
    result["self"] = this;
    result["config"] = config_;
    result["nested"] = Dictionary();
    result["nothing"] = Variant();
    return result;
}

Array Probe::list(int64_t count) const {
    Array result;
    for (int64_t i = 0; i < count; ++i) {
        result.push_back(i * i);
    }
    if (result.size() > 1) {
        result[1] = vformat("%s has %d", "item", int64_t(result[1]));
    }
    return result;
}

PackedFloat64Array Probe::doubled(const PackedFloat64Array &values) const {
    PackedFloat64Array result = values;
    double *data = result.ptrw();
    for (int64_t i = 0; i < result.size(); ++i) {
        data[i] *= 2.0;
    }
    return result;
}

PackedVector3Array Probe::mirrored(const PackedVector3Array &points) const {
    PackedVector3Array result;
    result.resize(points.size());
    for (int64_t i = 0; i < points.size(); ++i) {
        result[i] = -points[i];
    }
    return result;
}

PackedInt32Array Probe::counted(int32_t count) const {
    PackedInt32Array result;
    for (int32_t i = 0; i < count; ++i) {
        result.push_back(i);
    }
    return result;
}

Transform3D Probe::product(const Transform3D &a, const Transform3D &b) const {
    return a * b;
}

Dictionary Probe::rotation_facts(const Basis &basis) const {
    Dictionary facts;
    facts["quaternion"] = basis.get_rotation_quaternion();
    facts["transposed"] = basis.transposed();
    facts["inverse"] = basis.inverse();
    facts["orthonormalized"] = basis.orthonormalized();
    facts["determinant"] = basis.determinant();
    facts["affine_inverse"] = Transform3D(basis, Vector3(1, 2, 3)).affine_inverse();
    facts["inverse_transform"] = Transform3D(basis, Vector3(1, 2, 3)).inverse();
    facts["xform"] = Transform3D(basis, Vector3(1, 2, 3)).xform(Vector3(4, 5, 6));
    facts["from_quaternion"] = Basis(basis.get_rotation_quaternion());
    facts["column"] = basis.get_column(1);
    facts["scale"] = basis.get_scale();
    return facts;
}

Quaternion Probe::turned(const Quaternion &q, const Vector3 &axis, double angle_rad) const {
    return Quaternion(axis, static_cast<real_t>(angle_rad)) * q;
}

Node *Probe::first_child() const {
    return get_child_count() > 0 ? get_child(0) : nullptr;
}

bool Probe::is_probe(Object *object) const {
    return Object::cast_to<Probe>(object) != nullptr;
}

int64_t Probe::call_count_of(const Ref<ProbeCounter> &counter) const {
    return counter.is_valid() ? counter->get_reference_count() : -1;
}

int64_t Probe::owners_of_duplicate() const {
    // The engine returns a Ref: it must become ours without being counted twice.
    const Ref<Resource> copy = config_->duplicate();
    const Ref<ProbeConfig> config = copy;
    return config.is_valid() && config->get_rate_hz() == config_->get_rate_hz()
               ? config->get_reference_count()
               : -1;
}

Error Probe::emit_many() {
    return emit_signal("many", 7, 2.5, "text");
}

int64_t Probe::connect_own(bool connected) {
    const Callable callable = callable_mp(this, &Probe::on_many);
    if (connected) {
        connect("many", callable);
    } else {
        disconnect("many", callable);
    }
    return is_connected("many", callable_mp(this, &Probe::on_many)) ? 1 : 0;
}

void Probe::on_many(int64_t a, double b, const String &c) {
    heard_ += a + static_cast<int64_t>(b * 2.0) + c.length();
}

Dictionary Probe::engine_facts() const {
    Dictionary facts;
    facts["editor_hint"] = Engine::get_singleton()->is_editor_hint();
    facts["ticks"] = Engine::get_singleton()->get_physics_ticks_per_second();
    facts["version"] = Engine::get_singleton()->get_version_info();
    facts["os"] = OS::get_singleton()->get_name();
    facts["debug"] = OS::get_singleton()->is_debug_build();
    facts["project"] = ProjectSettings::get_singleton()->get_setting("application/config/name");
    facts["has"] = ProjectSettings::get_singleton()->has_setting("no/such/setting");
    return facts;
}

Dictionary Probe::text_facts() const {
    Dictionary facts;
    const String degree = String::utf8("5\xC2\xB0");
    facts["utf8"] = degree;
    facts["utf8_length"] = degree.length();
    facts["bytes"] = String::utf8(degree.utf8().get_data(), degree.utf8().length());
    facts["equal"] =
        String("a") == "a" && String("a") < String("b") && StringName("n") == String("n");
    facts["number"] = String::num(2.5);
    facts["from_int"] = String(Variant(5));
    facts["to_int"] = int64_t(Variant(2.75));
    facts["type"] = Variant::get_type_name(Variant(Vector3()).get_type());
    facts["split"] = String("a,b,c").split(",");
    facts["approx"] = UtilityFunctions::is_equal_approx(1.0, 1.0 + 1e-9);
    return facts;
}

int64_t Probe::check_index(int64_t index) const {
    ERR_FAIL_INDEX_V_MSG(index, kStrings, -1, vformat("String %d does not exist.", index));
    return index;
}

void Probe::make_child(const String &name) {
    Node3D *child = memnew(Node3D);
    child->set_name(name);
    child->set_position(Vector3(0, 1, 0));
    add_child(child);
}

String Probe::version_text(int64_t major, int64_t minor) {
    return vformat("%d.%d", major, minor);
}

void Probe::_notification(int what) {
    switch (what) {
    case NOTIFICATION_POSTINITIALIZE:
        note("postinitialize");
        break;
    case NOTIFICATION_ENTER_TREE:
        note("enter");
        set_process(true);
        set_physics_process_internal(true);
        break;
    case NOTIFICATION_READY:
        note("notified ready");
        break;
    case NOTIFICATION_EXIT_TREE:
        note("exit");
        break;
    case NOTIFICATION_PREDELETE:
        UtilityFunctions::print("probe: predelete");
        break;
    default:
        break;
    }
}

bool Probe::_set(const StringName &name, const Variant &value) {
    if (name != StringName("hidden_value")) {
        return false;
    }
    hidden_value_ = int64_t(value);
    return true;
}

bool Probe::_get(const StringName &name, Variant &value) const {
    if (name != StringName("hidden_value")) {
        return false;
    }
    value = hidden_value_;
    return true;
}

void Probe::_validate_property(PropertyInfo &property) const {
    if (property.name == StringName("gain")) {
        property.usage = PROPERTY_USAGE_NO_EDITOR;
        property.hint_string = "0,2,0.5";
    }
}

String Probe::_to_string() const {
    return vformat("<Probe mode %d>", mode_);
}

void DerivedProbe::_bind_methods() {
    ClassDB::bind_method(D_METHOD("get_ticks"), &DerivedProbe::get_ticks);
    ADD_PROPERTY(PropertyInfo(Variant::INT, "ticks", PROPERTY_HINT_NONE, "",
                              PROPERTY_USAGE_EDITOR | PROPERTY_USAGE_READ_ONLY),
                 "", "get_ticks");
}

void DerivedProbe::_physics_process(double) {
    ++ticks_;
}

void DerivedProbe::_notification(int what) {
    if (what == NOTIFICATION_ENTER_TREE) {
        note("derived enter");
    } else if (what == NOTIFICATION_EXIT_TREE) {
        note("derived exit");
    }
}

} // namespace probe
