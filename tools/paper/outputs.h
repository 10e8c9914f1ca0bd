// What the program leaves behind: CSV tables, and figures.csv with every number that the page quotes.
#pragma once

#include <cstdio>
#include <initializer_list>
#include <memory>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

namespace spidar::paper {

// One field of a row: text as it is, numbers to nine digits.
class Field {
public:
    Field(const char *text) : text_(text) {}
    Field(std::string text) : text_(std::move(text)) {}
    Field(int value) : text_(std::to_string(value)) {}
    Field(bool value) : text_(value ? "1" : "0") {}
    Field(double value) {
        char buffer[32];
        std::snprintf(buffer, sizeof(buffer), "%.9g", value);
        text_ = buffer;
    }
    [[nodiscard]] const std::string &text() const { return text_; }

private:
    std::string text_;
};

class CsvFile {
public:
    CsvFile(const std::string &path, const std::string &header)
        : path_(path), file_(std::fopen(path.c_str(), "w"), &std::fclose) {
        if (!file_) {
            throw std::runtime_error(path + ": cannot be written");
        }
        write(header);
    }
    void row(std::initializer_list<Field> fields) {
        std::string line;
        for (const Field &field : fields) {
            line += (line.empty() ? "" : ",") + field.text();
        }
        write(line);
    }

private:
    void write(const std::string &line) {
        if (std::fprintf(file_.get(), "%s\n", line.c_str()) < 0) {
            throw std::runtime_error(path_ + ": write failed (disk full?)");
        }
    }
    std::string path_;
    std::unique_ptr<std::FILE, int (*)(std::FILE *)> file_;
};

class Outputs {
public:
    explicit Outputs(std::string folder)
        : folder_(std::move(folder)), figures_(folder_ + "/figures.csv", "figure,value") {}
    [[nodiscard]] CsvFile table(const std::string &name, const std::string &header) const {
        return {folder_ + "/" + name + ".csv", header};
    }
    // A number that the page quotes; its name carries the unit.
    void figure(const std::string &name, const Field &value) { figures_.row({name, value}); }

private:
    std::string folder_;
    CsvFile figures_;
};

} // namespace spidar::paper
