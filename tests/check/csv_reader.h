// Strict reader for the reference files: comma separated, one header line, columns found by name.
#pragma once

#include <cstddef>
#include <stdexcept>
#include <string>
#include <vector>

namespace spidar::check {

// Message names the file, the line and the column.
struct CsvError : std::runtime_error {
    using std::runtime_error::runtime_error;
};

class CsvTable {
public:
    // Throws CsvError when the file cannot be read, has no header, a repeated column, or a row of another width.
    explicit CsvTable(const std::string &path);

    [[nodiscard]] std::size_t row_count() const { return rows_.size(); }
    [[nodiscard]] bool has_column(const std::string &name) const;
    // Throws CsvError naming the column when it is missing.
    [[nodiscard]] std::size_t column(const std::string &name) const;
    [[nodiscard]] const std::string &text(std::size_t row, std::size_t column) const;
    // Finite number; throws CsvError on anything else.
    [[nodiscard]] double number(std::size_t row, std::size_t column) const;

private:
    [[nodiscard]] std::string place(std::size_t row, std::size_t column) const;

    std::string path_;
    std::vector<std::string> header_;
    std::vector<std::vector<std::string>> rows_;
    std::vector<std::size_t> lines_; // line in the file of each row
};

} // namespace spidar::check
