// Section VI.1 and Table 1: length from counts by M1, by M2's printed equation, and by fits of ours.
#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "paper/measured_strings.h"
#include "paper/sections.h"

namespace spidar::paper {

namespace {

constexpr double kPulsesATurn = 2000.0;
constexpr double kPaperOffset_cm = 0.50744; // M2 as printed
constexpr double kPaperSlope_cm = 0.0026282;
constexpr double kPulseUnit = 10000.0; // keeps the normal equations near 1
constexpr int kMaxDegree = 3;

using Polynomial = std::vector<double>; // cm against pulses / kPulseUnit

double value(const Polynomial &polynomial, double pulses) {
    double sum = 0.0;
    for (auto c = polynomial.rbegin(); c != polynomial.rend(); ++c) {
        sum = sum * pulses / kPulseUnit + *c;
    }
    return sum;
}

// Least squares of real length on pulses, without row `left_out` (-1: all rows).
Polynomial fit(const std::vector<StringRow> &rows, int degree, int left_out) {
    const auto size = static_cast<std::size_t>(degree) + 1;
    std::vector<std::vector<double>> system(size, std::vector<double>(size + 1, 0.0));
    for (std::size_t row = 0; row < rows.size(); ++row) {
        if (static_cast<int>(row) == left_out) {
            continue;
        }
        std::vector<double> powers(size, 1.0);
        for (std::size_t k = 1; k < size; ++k) {
            powers[k] = powers[k - 1] * rows[row].pulses / kPulseUnit;
        }
        for (std::size_t i = 0; i < size; ++i) {
            for (std::size_t j = 0; j < size; ++j) {
                system[i][j] += powers[i] * powers[j];
            }
            system[i][size] += powers[i] * rows[row].real_cm;
        }
    }
    // Gauss; positive definite, so the diagonal serves as pivot.
    for (std::size_t k = 0; k < size; ++k) {
        for (std::size_t i = 0; i < size; ++i) {
            if (i != k) {
                const double factor = system[i][k] / system[k][k];
                for (std::size_t j = k; j <= size; ++j) {
                    system[i][j] -= factor * system[k][j];
                }
            }
        }
    }
    Polynomial polynomial(size);
    for (std::size_t k = 0; k < size; ++k) {
        polynomial[k] = system[k][size] / system[k][k];
    }
    return polynomial;
}

// Each row predicted by the fit to the six others (rms, cm).
double held_out_rms(const std::vector<StringRow> &rows, int degree) {
    double sum = 0.0;
    for (std::size_t row = 0; row < rows.size(); ++row) {
        const Polynomial polynomial = fit(rows, degree, static_cast<int>(row));
        const double miss = value(polynomial, rows[row].pulses) - rows[row].real_cm;
        sum += miss * miss;
    }
    return std::sqrt(sum / static_cast<double>(rows.size()));
}

struct Misfit {
    double square_sum = 0.0;
    double largest = 0.0;
    int count = 0;
    void add(double miss) {
        square_sum += miss * miss;
        largest = std::max(largest, std::abs(miss));
        ++count;
    }
    [[nodiscard]] double rms() const { return std::sqrt(square_sum / count); }
};

} // namespace

void string_errors(Outputs &outputs, const std::string &data_folder) {
    const std::vector<StringRow> rows = read_table1(data_folder);

    // Degree 1 is our counterpart of M2. Above, the radius changes with what is wound: a winding curve.
    int best_degree = 1;
    CsvFile models = outputs.table("table1_models", "model,held_out_rms_cm");
    for (int degree = 1; degree <= kMaxDegree; ++degree) {
        const double rms = held_out_rms(rows, degree);
        models.row({"degree " + std::to_string(degree), rms});
        outputs.figure("table1_held_out_rms_cm/degree " + std::to_string(degree), rms);
        best_degree = rms < held_out_rms(rows, best_degree) ? degree : best_degree;
    }
    const Polynomial affine = fit(rows, 1, -1);
    const Polynomial winding = fit(rows, best_degree, -1);

    Misfit m1;
    Misfit m2;
    Misfit equation;
    Misfit equation_to_column;
    Misfit ours;
    Misfit wound;
    CsvFile table =
        outputs.table("table1", "real_cm,m1_cm,m2_cm,pulses,m2_equation_cm,affine_cm,winding_cm");
    for (const StringRow &row : rows) {
        const double printed = kPaperOffset_cm + kPaperSlope_cm * row.pulses;
        const double affine_cm = value(affine, row.pulses);
        const double winding_cm = value(winding, row.pulses);
        m1.add(row.real_cm - row.m1_cm);
        m2.add(row.real_cm - row.m2_cm);
        equation.add(row.real_cm - printed);
        equation_to_column.add(printed - row.m2_cm);
        ours.add(row.real_cm - affine_cm);
        wound.add(row.real_cm - winding_cm);
        table.row({row.real_cm, row.m1_cm, row.m2_cm, row.pulses, printed, affine_cm, winding_cm});
    }
    outputs.figure("table1/m1_max_cm", m1.largest);
    outputs.figure("table1/m2_max_cm", m2.largest);
    outputs.figure("table1/m2_rms_cm", m2.rms());
    outputs.figure("table1/m2_equation_max_cm", equation.largest);
    outputs.figure("table1/m2_equation_to_column_max_cm", equation_to_column.largest);
    outputs.figure("table1/affine_offset_cm", affine[0]);
    outputs.figure("table1/affine_slope_cm", affine[1] / kPulseUnit);
    outputs.figure("table1/affine_rms_cm", ours.rms());
    outputs.figure("table1/affine_max_cm", ours.largest);
    outputs.figure("table1/effective_radius_mm",
                   10.0 * affine[1] / kPulseUnit * kPulsesATurn / (2.0 * std::numbers::pi));
    outputs.figure("table1/m2_effective_radius_mm",
                   10.0 * kPaperSlope_cm * kPulsesATurn / (2.0 * std::numbers::pi));
    outputs.figure("table1/winding_degree", best_degree);
    outputs.figure("table1/winding_rms_cm", wound.rms());
    outputs.figure("table1/winding_max_cm", wound.largest);
    outputs.figure("table1/mm_per_pulse", 10.0 * kIdealCmPerPulse);
}

} // namespace spidar::paper
