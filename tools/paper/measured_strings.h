// The strings as the paper measured them: Table 1, and the error it implies at any length.
#pragma once

#include <string>
#include <vector>

#include "core/base/types.h"

namespace spidar::paper {

struct StringRow {
    double real_cm = 0.0;
    double m1_cm = 0.0;  // counts times the ideal length per count
    double m2_cm = 0.0;  // the paper's least squares
    double pulses = 0.0; // counts behind m1_cm
};

// 2 pi 0.8 cm / 2000 (section VI.1).
inline constexpr double kIdealCmPerPulse = 0.2513274122871834 / 100.0;

// Throws check::CsvError when the file is not as it should be.
[[nodiscard]] std::vector<StringRow> read_table1(const std::string &data_folder);

// Reading of a string of given true length: the rows of Table 1 joined by lines, their error constant
// outside. All eight strings are taken to be alike.
class StringErrorModel {
public:
    enum class Method { ideal, m1, m2 };
    StringErrorModel(const std::vector<StringRow> &rows, Method method);
    [[nodiscard]] double reading_m(double length_m) const;
    [[nodiscard]] StringArray readings_m(const StringArray &lengths_m) const;

private:
    std::vector<double> real_m_;
    std::vector<double> error_m_; // real - reading
};

} // namespace spidar::paper
