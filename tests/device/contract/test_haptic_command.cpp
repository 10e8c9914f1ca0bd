#include <doctest/doctest.h>

#include <limits>

#include "device/contract/haptic_command.h"

using namespace spidar;

namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr double kInfinity = std::numeric_limits<double>::infinity();

} // namespace

TEST_CASE("wrench request: NaN or infinity in any of its eight numbers is refused") {
    for (const double bad : {kNan, kInfinity, -kInfinity}) {
        for (int field = 0; field < 8; ++field) {
            PaperWrench q{};
            double duration_s = 0.05;
            (field < 7 ? q[static_cast<std::size_t>(field)] : duration_s) = bad;
            CAPTURE(field);
            CHECK(validate_wrench(from_paper(q), duration_s) == Status::not_finite);
        }
    }
}

TEST_CASE("wrench request: durations") {
    CHECK(validate_wrench(Wrench(), 0.0) == Status::ok);
    CHECK(validate_wrench(Wrench(), kMaxWrenchDuration_s) == Status::ok);
    CHECK(validate_wrench(Wrench(), -1e-9) == Status::invalid_request);
    CHECK(validate_wrench(Wrench(), kMaxWrenchDuration_s * 1.01) == Status::invalid_request);
    CHECK(validate_wrench({Vec3(1e308), Vec3(-1e308), 1e308}, 0.05) == Status::ok); // clamped later
}

TEST_CASE("contact: every malformed field is refused, the default is fine") {
    CHECK(validate_contact(ContactPlane()) == Status::ok);
    for (int field = 0; field < 10; ++field) {
        for (const double bad : {kNan, kInfinity}) {
            ContactPlane plane;
            double *const fields[] = {&plane.normal.x,       &plane.normal.y,
                                      &plane.normal.z,       &plane.offset_m,
                                      &plane.velocity_m_s.x, &plane.velocity_m_s.y,
                                      &plane.velocity_m_s.z, &plane.stiffness_n_m,
                                      &plane.damping_n_s_m,  &plane.friction};
            *fields[field] = bad;
            CAPTURE(field);
            CHECK(validate_contact(plane) == Status::not_finite);
        }
    }
    const auto refused = [](auto change) {
        ContactPlane plane;
        change(plane);
        return validate_contact(plane) == Status::invalid_request;
    };
    CHECK(refused([](ContactPlane &p) { p.normal = Vec3(0.0); }));
    CHECK(refused([](ContactPlane &p) { p.normal = Vec3(0.0, 1.1, 0.0); }));
    CHECK(refused([](ContactPlane &p) { p.normal = Vec3(1e200, 1e200, 0.0); }));
    CHECK(refused([](ContactPlane &p) { p.stiffness_n_m = -1.0; }));
    CHECK(refused([](ContactPlane &p) { p.damping_n_s_m = -1.0; }));
    CHECK(refused([](ContactPlane &p) { p.friction = -0.1; }));
    CHECK(refused([](ContactPlane &p) { p.target = static_cast<ContactTarget>(7); }));
    // A grasp stop has only x, which is a direction.
    CHECK(refused([](ContactPlane &p) { p.target = ContactTarget::grasp_stop; }));
    ContactPlane stop;
    stop.target = ContactTarget::grasp_stop;
    stop.normal = Vec3(-1.0, 0.0, 0.0);
    CHECK(validate_contact(stop) == Status::ok);
}

TEST_CASE("contact set: the count is checked, and only the contacts that it covers") {
    HapticCommand command;
    command.contacts[3].offset_m = kNan;
    command.contact_count = 3;
    CHECK(validate_contacts(command) == Status::ok);
    command.contact_count = 4;
    CHECK(validate_contacts(command) == Status::not_finite);
    command.contact_count = -1;
    CHECK(validate_contacts(command) == Status::invalid_request);
    command.contact_count = kMaxContacts + 1;
    CHECK(validate_contacts(command) == Status::invalid_request);
}
