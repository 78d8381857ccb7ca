#pragma once

#include <string>
#include <utility>
#include <variant>

namespace exitance {

/// The kind of an error: for programs, tests and the exit status.
enum class ErrorCode {
    usage,         ///< An option or an argument is wrong.
    bad_input,     ///< A file's content is wrong.
    cannot_read,   ///< A file cannot be opened or read.
    cannot_write,  ///< A file cannot be written.
    limit,         ///< A limit on time or memory is too small for any result.
    failure,       ///< Anything else.
};

/// Why something failed, for programs and for people.
struct Error {
    ErrorCode code = ErrorCode::failure;
    std::string message;  ///< One sentence that contains the offending values.
    std::string where;    ///< "room.obj:41", "--error", or empty.
    std::string hint;     ///< Suggested action, or empty.
};

/// A value, or the reason why there is none.
template <class T>
class [[nodiscard]] Result {
  public:
    Result(T value) : content_(std::move(value)) {}
    Result(Error error) : content_(std::move(error)) {}

    explicit operator bool() const { return std::holds_alternative<T>(content_); }
    T& operator*() { return std::get<T>(content_); }
    const T& operator*() const { return std::get<T>(content_); }
    T* operator->() { return &std::get<T>(content_); }
    const T* operator->() const { return &std::get<T>(content_); }
    const Error& error() const { return std::get<Error>(content_); }

  private:
    std::variant<T, Error> content_;
};

/// Success, or the reason why not.
template <>
class [[nodiscard]] Result<void> {
  public:
    Result() = default;
    Result(Error error) : error_(std::move(error)), failed_(true) {}

    explicit operator bool() const { return !failed_; }
    const Error& error() const { return error_; }

  private:
    Error error_;
    bool failed_ = false;
};

}  // namespace exitance
