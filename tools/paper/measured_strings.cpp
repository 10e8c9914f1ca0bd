#include "paper/measured_strings.h"

#include "check/csv_reader.h"

namespace spidar::paper {

std::vector<StringRow> read_table1(const std::string &data_folder) {
    const check::CsvTable table(data_folder + "/table1.csv");
    const std::size_t real = table.column("real_cm");
    const std::size_t m1 = table.column("m1_cm");
    const std::size_t m2 = table.column("m2_cm");
    std::vector<StringRow> rows;
    for (std::size_t row = 0; row < table.row_count(); ++row) {
        const double m1_cm = table.number(row, m1);
        rows.push_back(
            {table.number(row, real), m1_cm, table.number(row, m2), m1_cm / kIdealCmPerPulse});
    }
    if (rows.size() < 4) {
        throw check::CsvError(data_folder + "/table1.csv: needs 4 rows or more");
    }
    for (std::size_t i = 1; i < rows.size(); ++i) {
        if (!(rows[i].real_cm > rows[i - 1].real_cm)) {
            throw check::CsvError(data_folder + "/table1.csv: real_cm must rise from row to row");
        }
    }
    return rows;
}

StringErrorModel::StringErrorModel(const std::vector<StringRow> &rows, Method method) {
    for (const StringRow &row : rows) {
        const double reading = method == Method::ideal ? row.real_cm
                               : method == Method::m1  ? row.m1_cm
                                                       : row.m2_cm;
        real_m_.push_back(0.01 * row.real_cm);
        error_m_.push_back(0.01 * (row.real_cm - reading));
    }
}

double StringErrorModel::reading_m(double length_m) const {
    if (length_m <= real_m_.front()) {
        return length_m - error_m_.front();
    }
    for (std::size_t i = 1; i < real_m_.size(); ++i) {
        if (length_m <= real_m_[i]) {
            const double part = (length_m - real_m_[i - 1]) / (real_m_[i] - real_m_[i - 1]);
            return length_m - (error_m_[i - 1] + part * (error_m_[i] - error_m_[i - 1]));
        }
    }
    return length_m - error_m_.back();
}

StringArray StringErrorModel::readings_m(const StringArray &lengths_m) const {
    StringArray readings{};
    for (std::size_t i = 0; i < readings.size(); ++i) {
        readings[i] = reading_m(lengths_m[i]);
    }
    return readings;
}

} // namespace spidar::paper
