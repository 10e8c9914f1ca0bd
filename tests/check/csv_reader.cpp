#include "check/csv_reader.h"

#include <charconv>
#include <cmath>
#include <fstream>

namespace spidar::check {

namespace {

std::vector<std::string> split(const std::string &line) {
    std::vector<std::string> fields;
    std::size_t start = 0;
    for (;;) {
        const std::size_t comma = line.find(',', start);
        std::string field = line.substr(start, comma - start);
        const std::size_t first = field.find_first_not_of(" \t");
        const std::size_t last = field.find_last_not_of(" \t");
        fields.push_back(first == std::string::npos ? "" : field.substr(first, last - first + 1));
        if (comma == std::string::npos) {
            return fields;
        }
        start = comma + 1;
    }
}

void strip_carriage_return(std::string &line) {
    if (!line.empty() && line.back() == '\r') {
        line.pop_back();
    }
}

// Spreadsheets begin a UTF-8 file with it.
void strip_byte_order_mark(std::string &line) {
    constexpr const char *kMark = "\xEF\xBB\xBF";
    if (line.rfind(kMark, 0) == 0) {
        line.erase(0, 3);
    }
}

} // namespace

CsvTable::CsvTable(const std::string &path) : path_(path) {
    std::ifstream file(path);
    if (!file) {
        throw CsvError(path + ": cannot be read; check the path.");
    }
    std::string line;
    if (!std::getline(file, line)) {
        throw CsvError(path + ": is empty; the first line must name the columns.");
    }
    strip_carriage_return(line);
    strip_byte_order_mark(line);
    header_ = split(line);
    for (std::size_t i = 0; i < header_.size(); ++i) {
        for (std::size_t j = 0; j < i; ++j) {
            if (header_[i] == header_[j]) {
                throw CsvError(path + ":1: column '" + header_[i] + "' appears twice.");
            }
        }
    }
    for (std::size_t line_number = 2; std::getline(file, line); ++line_number) {
        strip_carriage_return(line);
        if (line.empty()) {
            continue;
        }
        std::vector<std::string> fields = split(line);
        if (fields.size() != header_.size()) {
            throw CsvError(path + ":" + std::to_string(line_number) + ": has " +
                           std::to_string(fields.size()) + " fields, the header has " +
                           std::to_string(header_.size()) + ".");
        }
        rows_.push_back(std::move(fields));
        lines_.push_back(line_number);
    }
    if (file.bad()) {
        throw CsvError(path + ": reading stopped before the end.");
    }
}

bool CsvTable::has_column(const std::string &name) const {
    for (const std::string &field : header_) {
        if (field == name) {
            return true;
        }
    }
    return false;
}

std::size_t CsvTable::column(const std::string &name) const {
    for (std::size_t i = 0; i < header_.size(); ++i) {
        if (header_[i] == name) {
            return i;
        }
    }
    throw CsvError(path_ + ":1: column '" + name + "' is missing.");
}

const std::string &CsvTable::text(std::size_t row, std::size_t column) const {
    return rows_.at(row).at(column);
}

double CsvTable::number(std::size_t row, std::size_t column) const {
    const std::string &field = text(row, column);
    const char *first = field.data();
    const char *last = first + field.size();
    if (field.size() > 1 && *first == '+') {
        ++first; // from_chars takes no plus sign
    }
    double value = 0.0;
    const auto [end, error] = std::from_chars(first, last, value);
    if (field.empty() || error != std::errc() || end != last || !std::isfinite(value)) {
        throw CsvError(place(row, column) + " is '" + field + "', no finite number.");
    }
    return value;
}

std::string CsvTable::place(std::size_t row, std::size_t column) const {
    return path_ + ":" + std::to_string(lines_.at(row)) + ": column '" + header_.at(column) + "'";
}

} // namespace spidar::check
