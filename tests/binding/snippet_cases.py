"""What compiles with a binding and what does not: snippet_cases.py INCLUDE_FOLDER... prints the totals as its last line.

MUST compile with every binding. MUST_NOT is what godot-cpp refuses, in some version at least, or reads differently: the
in-tree binding has to refuse it too, or sources written here would break there. Each of those names words of the error that it wants, so that it
is not refused for a slip of the pen. With a real godot-cpp only MUST is tried.
"""

import concurrent.futures
import os
import shlex
import subprocess
import sys
import tempfile
from pathlib import Path

HERE = Path(__file__).resolve().parent
COMPILER = shlex.split(os.environ.get("CXX", "g++"))
LIMIT_S = 120

# A class of ours; `{}` is what it has beside its _bind_methods.
CLASS = """class Thing : public {parent} {{
    GDCLASS(Thing, {parent})
public:
{members}
protected:
    static void _bind_methods() {{ {binds} }}
}};
void enter() {{ GDREGISTER_CLASS(Thing); }}
"""


def thing(members="", binds="", parent="Node3D"):
    return CLASS.format(parent=parent, members=members, binds=binds)


def method(declaration, name="f"):
    return thing(declaration, f'ClassDB::bind_method(D_METHOD("{name}"), &Thing::{name});')


def body(code):
    return "void f() {\n" + code + "\n}\n"


MUST = {
    "a class": thing(),
    "a resource": thing(parent="Resource"),
    "two levels": thing() + """class Other : public Thing {
    GDCLASS(Other, Thing)
protected:
    static void _bind_methods() {}
};
void enter_other() { GDREGISTER_CLASS(Other); }
""",
    "an abstract class": """class Base : public Node {
    GDCLASS(Base, Node)
public:
    virtual int64_t f() const = 0;
protected:
    static void _bind_methods() {}
};
void enter() { GDREGISTER_ABSTRACT_CLASS(Base); }
""",
    "virtual methods": thing("void _ready() override {}\nvoid _process(double) override {}\n"
                             "PackedStringArray _get_configuration_warnings() const override { return {}; }"),
    "hooks": thing("""void _notification(int) {}
bool _set(const StringName &, const Variant &) { return false; }
bool _get(const StringName &, Variant &) const { return false; }
void _validate_property(PropertyInfo &) const {}
String _to_string() const { return String(); }"""),
    "an enum": """class Thing : public Node {
    GDCLASS(Thing, Node)
public:
    enum Mode { MODE_A, MODE_B };
    void set_mode(Mode) {}
    Mode get_mode() const { return MODE_B; }
protected:
    static void _bind_methods();
};
}
VARIANT_ENUM_CAST(@::Thing::Mode);
namespace @ {
void Thing::_bind_methods() {
    ClassDB::bind_method(D_METHOD("set_mode", "mode"), &Thing::set_mode);
    ClassDB::bind_method(D_METHOD("get_mode"), &Thing::get_mode);
    ADD_PROPERTY(PropertyInfo(Variant::INT, "mode"), "set_mode", "get_mode");
    BIND_ENUM_CONSTANT(MODE_A);
}
void enter() { GDREGISTER_CLASS(Thing); }
""",
    "a signal and a default": thing("void f(double a, int64_t b) { emit_signal(\"told\", a, b); }", """
ClassDB::bind_method(D_METHOD("f", "a", "b"), &Thing::f, DEFVAL(1));
ADD_SIGNAL(MethodInfo("told", PropertyInfo(Variant::FLOAT, "a"), PropertyInfo(Variant::INT, "b")));"""),
    "a static method": thing("static int64_t f(int32_t a) { return a; }",
                             'ClassDB::bind_static_method("Thing", D_METHOD("f", "a"), &Thing::f);'),
    "objects as arguments": method("Ref<Resource> f(const Ref<Resource> &r, Node *n) { return n ? r : Ref<Resource>(); }"),
    "a callable": thing("void f(int64_t) {}\nvoid g() { connect(\"told\", callable_mp(this, &Thing::f)); }"),
    "values in and out": body("""Variant a = 5; Variant b = 2.5; Variant c = true; Variant d = "text"; Variant e = Vector3(1, 2, 3);
int64_t i = int64_t(a); double x = double(b); String s = String(d); Vector3 v = Vector3(e); bool y = c.booleanize();
static_cast<void>(i); static_cast<void>(x); static_cast<void>(v); static_cast<void>(y); UtilityFunctions::print(s, a);"""),
    "containers": body("""Array a = Array::make(1, "two", 3.5); a.push_back(Dictionary()); Dictionary d; d["key"] = a;
PackedFloat64Array p; p.push_back(1.0); double *w = p.ptrw(); static_cast<void>(w); TypedArray<Node> t;
static_cast<void>(t);"""),
    "texts": body("""String s = String("a") + String("b"); s += String::num(2.5); s = vformat("%s %d", s, 3);
bool same = s == "ab" && StringName("a") == StringName("a"); static_cast<void>(same);"""),
    "mathematics": body("""Vector3 v = Vector3(1, 2, 3) * 2 + Vector3(0, 1, 0).cross(Vector3(1, 0, 0)); Basis b(Vector3(0, 1, 0), 0.5F);
Transform3D t(b, v); t = t.affine_inverse() * t; Quaternion q = b.get_rotation_quaternion();
bool fine = t.is_finite() && q.is_finite(); static_cast<void>(fine);"""),
    "memory": body("""Node3D *n = memnew(Node3D); Node *m = Object::cast_to<Node>(n); static_cast<void>(m); memdelete(n);
Ref<Resource> r; r.instantiate(); static_cast<void>(r.is_valid()); WARN_PRINT("text");"""),
    "checks": "int64_t f(int64_t i) { ERR_FAIL_INDEX_V_MSG(i, 8, -1, vformat(\"%d\", i)); return i; }\n",
}

NO_CARRY = "that the engine cannot"
MUST_NOT = {
    "long long argument": (method("void f(long long) {}"), NO_CARRY),
    "unsigned long long argument": (method("void f(unsigned long long) {}"), NO_CARRY),
    "char argument": (method("void f(char) {}"), NO_CARRY),
    "long double argument": (method("void f(long double) {}"), NO_CARRY),
    "wchar_t argument": (method("void f(wchar_t) {}"), NO_CARRY),
    "long long result": (method("long long f() { return 1; }"), NO_CARRY),
    "char result": (method("char f() { return 'a'; }"), NO_CARRY),
    "pointer argument": (method("void f(const char *) {}"), NO_CARRY),
    "std::string argument": (method("void f(const std::string &) {}"), NO_CARRY),
    "Variant of a long long literal": (body("Variant v(5LL);"), "Variant"),
    "Variant of a long long": (body("long long x = 5; Variant v = x;"), "Variant"),
    "Variant of a long double": (body("Variant v(1.0L);"), "Variant"),
    "Variant of a scoped enum": ("enum class Color2 { A };\n" + body("Variant v(Color2::A);"), "Variant"),
    "long long in an Array": (body("Array a = Array::make(5LL);"), "Variant"),
    "long long in vformat": (body('String s = vformat("%d", 5LL);'), "Variant"),
    "long long emitted": (thing('void f() { emit_signal("told", 5LL); }'), "Variant"),
    "long long in a Dictionary": (body('Dictionary d; d["a"] = 5LL;'), "operator="),
    "long long out of a Variant": (body("Variant v(5); auto x = static_cast<long long>(v);"), "static_cast"),
    "char out of a Variant": (body("Variant v(5); auto x = static_cast<char>(v);"), "static_cast"),
    "enum out of a Variant": ("enum E { A };\n" + body("Variant v(5); auto x = static_cast<E>(v);"), "static_cast"),
    "number out of a Variant without a cast": (body("Variant v(5); int64_t x = v;"), "cannot convert"),
    "constant vector": (body("constexpr Vector3 v(1, 2, 3);"), "constexpr"),
    "constant vector by default": (body("constexpr Vector3 v;"), "constexpr"),
    "constant sum": (body("constexpr float x = (Vector3(1, 2, 3) + Vector3()).x;"), "constexpr"),
    "constant basis": (body("constexpr Basis b;"), "constexpr"),
    "constant quaternion": (body("constexpr Quaternion q(0, 0, 0, 1);"), "constexpr"),
    "constant transform": (body("constexpr Transform3D t;"), "constexpr"),
    "constant colour": (body("constexpr Color c(1, 1, 1);"), "constexpr"),
    "constant plane": (body("constexpr Plane p;"), "constexpr"),
    "constant RID": (body("constexpr RID r;"), "constexpr"),
    "const String returned": (method("const String f() const { return String(); }"), "const value"),
    "const number returned": (method("const int64_t f() const { return 1; }"), "const value"),
    "const Ref returned": (method("const Ref<Resource> f() const { return Ref<Resource>(); }"), "const value"),
    "no _bind_methods": ("""class Thing : public Node {
    GDCLASS(Thing, Node)
};
void enter() { GDREGISTER_CLASS(Thing); }
""", "_bind_methods"),
    "no _bind_methods in the second level": (thing() + """class Other : public Thing {
    GDCLASS(Other, Thing)
};
void enter_other() { GDREGISTER_CLASS(Other); }
""", "_bind_methods"),
    "no GDCLASS in the second level": (thing() + """class Other : public Thing {
protected:
    static void _bind_methods() {}
};
void enter_other() { GDREGISTER_CLASS(Other); }
""", "GDCLASS"),
    "callable of an engine method": (thing("Callable f() { return callable_mp(this, &Node::queue_free); }"), "own class"),
    "callable of a parent's method": (thing("void f() {}") + """class Other : public Thing {
    GDCLASS(Other, Thing)
public:
    Callable g() { return callable_mp(this, &Thing::f); }
protected:
    static void _bind_methods() {}
};
""", "own class"),
    "an abstract class as a plain one": ("""class Base : public Node {
    GDCLASS(Base, Node)
public:
    virtual int64_t f() const = 0;
protected:
    static void _bind_methods() {}
};
void enter() { GDREGISTER_CLASS(Base); }
""", "GDREGISTER_ABSTRACT_CLASS"),
    "a template class": ("""template <class T>
class Thing : public Node {
    GDCLASS(Thing, Node)
protected:
    static void _bind_methods() {}
};
void enter() { GDREGISTER_CLASS(Thing<int>); }
""", "template"),
    "a template class with a number": ("""template <int N>
class Thing : public Node {
    GDCLASS(Thing, Node)
protected:
    static void _bind_methods() {}
};
void enter() { GDREGISTER_CLASS(Thing<3>); }
""", "template"),
    "an enum that is not cast": (thing("enum E { A };\nvoid f(E) {}",
                                       'ClassDB::bind_method(D_METHOD("f", "a"), &Thing::f);'), "EnumName"),
    "a hook with other types": (thing("void _notification(int64_t) {}"), "hook"),
    "a writable reference": (method("void f(String &) {}"), ""),
    "text plus a literal": (body('String s = String("a") + "b";'), "deleted"),
    "name against a literal": (body('bool b = StringName("a") == "a";'), "deleted"),
    "memnew with arguments": (thing("Thing() = default;\nexplicit Thing(int) {}") + body("memnew(Thing(3));"), ""),
    "more defaults than arguments": (thing("void f() {}", 'ClassDB::bind_method(D_METHOD("f"), &Thing::f, DEFVAL(1));'),
                                     "More default values"),
}


class Compiler:
    """Compiles texts with the headers of a binding, the prelude precompiled once."""

    def __init__(self, folder, includes):
        self.folder = Path(folder)
        self.flags = ["-std=c++20", "-w", *[f"-isystem{path}" for path in includes]]
        prelude = self.folder / "prelude.hpp"
        prelude.write_text((HERE / "snippets" / "prelude.hpp").read_text())
        self.problem = self.run([*self.flags, "-x", "c++-header", str(prelude), "-o", f"{prelude}.gch"])

    @staticmethod
    def run(arguments):
        """What the compiler says; empty when it accepts."""
        done = subprocess.run([*COMPILER, *arguments], text=True, errors="replace", capture_output=True, check=False,
                              timeout=LIMIT_S, env=dict(os.environ, LC_ALL="C"))
        return "" if done.returncode == 0 else done.stderr or f"exit code {done.returncode}"

    def compile(self, name, text):
        source = self.folder / (name + ".cpp")
        source.write_text('#include "prelude.hpp"\n' + text)
        return self.run([*self.flags, "-fsyntax-only", "-fmax-errors=3", str(source)])


def run(check, includes, in_tree=True):
    with tempfile.TemporaryDirectory() as folder:
        compiler = Compiler(folder, includes)
        check(not compiler.problem, f"the headers compile: {compiler.problem[:2000]}")
        if compiler.problem:
            return
        # Those that must compile go through the compiler together.
        together = "".join(f"namespace n{i} {{\n{text.replace('@', f'n{i}')}}}\n" for i, text in enumerate(MUST.values()))
        jobs = {"all that must compile": ("must", together, None)}
        if in_tree:
            for i, (name, (text, words)) in enumerate(MUST_NOT.items()):
                jobs[name] = (f"must_not_{i}", "namespace n {\n" + text + "}\n", words)
        with concurrent.futures.ThreadPoolExecutor(os.cpu_count() or 1) as pool:
            told = dict(zip(jobs, pool.map(lambda job: compiler.compile(*job[:2]), jobs.values())))
        for name, (_, _, words) in jobs.items():
            if words is None:
                check(not told[name], f"{name}: {told[name][:3000]}")
            else:
                check(told[name] and words in told[name], f"snippet that must not compile: {name}: {told[name][:600]}")


def main(includes):
    totals = {True: 0, False: 0}

    def check(good, what):
        totals[bool(good)] += 1
        if not good:
            print("FAIL", what)

    run(check, includes)
    print(f"{totals[True]} passed, {totals[False]} failed")
    return 1 if totals[False] or not totals[True] else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
