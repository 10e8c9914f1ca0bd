#include <doctest/doctest.h>

#include "device/contract/device_claims.h"

using spidar::DeviceClaim;

TEST_CASE("device claims: one owner a device, named to the second who asks") {
    DeviceClaim first;
    DeviceClaim second;
    CHECK(first.take("claims/a", "NodeA"));
    CHECK_FALSE(second.take("claims/a", "NodeB"));
    CHECK(DeviceClaim::owner_of("claims/a") == "NodeA");
    CHECK(second.take("claims/b", "NodeB"));
    first.release();
    CHECK(DeviceClaim::owner_of("claims/a").empty());
    CHECK(second.take("claims/a", "NodeB")); // and lets b go
    CHECK(DeviceClaim::owner_of("claims/b").empty());
    CHECK(second.take("claims/a", "NodeB")); // its own: granted again
}

TEST_CASE("device claims: a refused claim keeps what it had") {
    DeviceClaim holder;
    DeviceClaim other;
    REQUIRE(holder.take("claims/c", "Holder"));
    REQUIRE(other.take("claims/d", "Other"));
    CHECK_FALSE(other.take("claims/c", "Other"));
    CHECK(DeviceClaim::owner_of("claims/d") == "Other");
}

TEST_CASE("device claims: the empty name is private and always granted") {
    DeviceClaim a;
    DeviceClaim b;
    CHECK(a.take("", "A"));
    CHECK(b.take("", "B"));
    CHECK(DeviceClaim::owner_of("").empty());
}

TEST_CASE("device claims: the end of a life gives the claim back") {
    {
        DeviceClaim inner;
        REQUIRE(inner.take("claims/e", "Inner"));
        CHECK(DeviceClaim::owner_of("claims/e") == "Inner");
    }
    CHECK(DeviceClaim::owner_of("claims/e").empty());
}
