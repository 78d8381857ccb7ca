#pragma once

#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "exitance/base/result.hpp"

namespace exitance {

/// Reads a text file line by line, in memory that does not grow with the file. "-" is standard input.
class LineReader {
  public:
    static Result<LineReader> open(const std::string& path);

    LineReader(LineReader&& other) noexcept;
    LineReader& operator=(LineReader&&) = delete;
    ~LineReader();

    /// Returns the next line without its end (LF, CRLF, or CR in files without LF); empty at the end of the file and
    /// after a read error. Valid until the next call.
    std::optional<std::string_view> next();
    /// Returns the next line that is neither blank nor a comment (#).
    std::optional<std::string_view> next_content();

    bool failed() const { return error_ != 0; }
    Error read_error() const;  ///< Error of reading the file; only valid if failed().
    Error error(std::string message, std::string hint = {}) const;  ///< Error (bad_input) at the current line, if any.
    int line() const { return line_; }                              ///< Number of the line returned last, from 1.

  private:
    LineReader() = default;
    bool fill();

    std::string name_, buffer_;
    std::size_t begin_ = 0, end_ = 0;
    int file_ = -1, line_ = 0, error_ = 0;
    bool at_end_ = false;
    char line_end_ = '\n';
};

/// Parses `text`, apart from blanks around it, as one number; empty if it is not a number or is too large.
std::optional<double> parse_number(std::string_view text);

/// Reads numbers from a CSV file with a header. Columns are found by name, in any order; others are ignored.
class NumberTable {
  public:
    /// Opens a file. In each row, the `required` columns come first, then the `optional` ones.
    static Result<NumberTable> open(const std::string& path, const std::vector<std::string>& required,
                                    const std::vector<std::string>& optional = {});
    /// Continues with `lines`, from which the caller has read up to and including the header.
    static Result<NumberTable> open(LineReader lines, std::string_view header, const std::vector<std::string>& required,
                                    const std::vector<std::string>& optional = {});

    bool has(std::size_t optional_column) const { return has_[optional_column]; }
    /// Reads the next row; false at the end. A missing or empty optional field is NaN.
    Result<bool> next(std::span<double> row);
    const LineReader& lines() const { return lines_; }

  private:
    explicit NumberTable(LineReader lines) : lines_(std::move(lines)) {}

    LineReader lines_;
    std::vector<int> slot_;  ///< Position in the row per column of the file, or -1.
    std::vector<std::string> names_;
    std::size_t required_ = 0;
    std::vector<bool> has_;
};

}  // namespace exitance
