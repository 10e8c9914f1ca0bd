// spidar_serial_tests: the serial transport against boards on a pseudo-terminal.
#define DOCTEST_CONFIG_IMPLEMENT
#include <doctest/doctest.h>

int main(int count, char **words) {
    doctest::Context context(count, words);
    return context.run();
}
