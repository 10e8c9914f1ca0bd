// The lists of fields: complete, in order, and back again.
#include <doctest/doctest.h>

#include <random>
#include <set>
#include <string>
#include <vector>

#include "device/recording/codec/command_fields.h"
#include "device/recording/codec/reading_fields.h"
#include "device/recording/codec/settings_fields.h"

using namespace spidar;

namespace {

struct Three {
    int a = 0;
    Vec3 b{0.0};
    std::array<ContactPlane, 2> c{};
};

// Every name with its index appears once.
template <typename Struct>
void check_names() {
    std::set<std::string> names;
    std::size_t fields = 0;
    const Struct value{};
    for_each_field(value, [&](std::string_view name, int index, const auto &) {
        names.insert(std::string(name) + "." + std::to_string(index));
        ++fields;
    });
    CHECK(names.size() == fields);
    CHECK(fields == count_fields(Struct{}));
    CHECK(fields > 0);
}

} // namespace

TEST_CASE("field words: members of a struct are counted, arrays as one") {
    static_assert(count_members<Three>() == 3);
    static_assert(count_members<Vec3>() != 0);
    check_names<HapticCommand>();
    check_names<ServoSettings>();
    check_names<DeviceReading>();
}

TEST_CASE("field words: a command comes back word by word, each word its own field") {
    std::mt19937_64 random(3);
    const std::size_t count = count_fields(HapticCommand{});
    std::vector<std::uint64_t> words(count);
    HapticCommand command;
    std::size_t next = 0;
    for_each_field(command, [&](std::string_view, int, auto &field) {
        from_word(random(), field);
        words[next] = to_word(field);
        ++next;
    });
    HapticCommand back;
    load_words(words, back);
    std::vector<std::uint64_t> again(count);
    store_words(back, again);
    CHECK(again == words);
    CHECK(back.contact_count == command.contact_count);
    CHECK(back.contacts[7].id == command.contacts[7].id);
    CHECK(to_word(back.wrench.moment_nm.z) == to_word(command.wrench.moment_nm.z));
}

TEST_CASE("field words: the schema tells commands, settings and readings apart") {
    CHECK(schema_of(HapticCommand{}) != schema_of(ServoSettings{}));
    CHECK(schema_of(HapticCommand{}) != schema_of(DeviceReading{}));
    HapticCommand other;
    other.arm_count = 5;
    CHECK(schema_of(other) == schema_of(HapticCommand{})); // of the form, not of the values
}
