#pragma once

#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "exitance/base/result.hpp"

namespace exitance {

/// The lines of a text file, one after the other, in memory that does not grow with the file; "-" is standard input.
class LineReader {
  public:
    static Result<LineReader> open(const std::string& path);

    LineReader(LineReader&& other) noexcept;
    LineReader& operator=(LineReader&&) = delete;
    ~LineReader();

    /// The next line without its end (LF or CRLF); nothing at the end of the file or when reading failed. Valid until
    /// the next call.
    std::optional<std::string_view> next();
    /// The next line that is neither blank nor a comment (#).
    std::optional<std::string_view> next_content();

    bool failed() const { return error_ != 0; }
    Error read_error() const;                                       ///< When failed().
    Error error(std::string message, std::string hint = {}) const;  ///< bad_input at the present line.
    int line() const { return line_; }                              ///< Of the line returned last, from 1.

  private:
    LineReader() = default;
    bool fill();

    std::string name_, buffer_;
    std::size_t begin_ = 0, end_ = 0;
    int file_ = -1, line_ = 0, error_ = 0;
    bool at_end_ = false;
};

/// A number that fills all of `text` but for blanks around it; nothing when it is none, or too large.
std::optional<double> parse_number(std::string_view text);

/// Numbers of a CSV file with a header, by the names of their columns, in any order; further columns are ignored.
class NumberTable {
  public:
    /// Columns that must be there come first in every row, those that may be there after them.
    static Result<NumberTable> open(const std::string& path, const std::vector<std::string>& required,
                                    const std::vector<std::string>& optional = {});
    /// The same, its lines so far read by somebody else up to the header.
    static Result<NumberTable> open(LineReader lines, std::string_view header, const std::vector<std::string>& required,
                                    const std::vector<std::string>& optional = {});

    bool has(std::size_t optional_column) const { return has_[optional_column]; }
    /// Reads the next row; false at the end. What is missing or empty among the optional columns is NaN.
    Result<bool> next(std::span<double> row);
    const LineReader& lines() const { return lines_; }

  private:
    explicit NumberTable(LineReader lines) : lines_(std::move(lines)) {}

    LineReader lines_;
    std::vector<int> slot_;  ///< Per column of the file: where its number goes, or -1.
    std::vector<std::string> names_;
    std::size_t required_ = 0;
    std::vector<bool> has_;
};

}  // namespace exitance
