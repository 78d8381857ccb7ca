#pragma once

#include <stdexcept>
#include <string>
#include <utility>
#include <variant>

namespace exitance::api {

/// The kind of an error, for programs.
enum class ErrorCode {
    usage,         ///< An argument is wrong.
    bad_input,     ///< The content of a file or of a scene is wrong.
    cannot_read,   ///< A file cannot be opened or read.
    cannot_write,  ///< A file cannot be written.
    limit,         ///< A limit on time or memory, or a stop, left no result.
    failure,       ///< Anything else.
};

/// Why something failed.
struct Error {
    ErrorCode code = ErrorCode::failure;
    std::string message;  ///< One sentence that contains the offending values.
    std::string where;    ///< "room.obj:41", "--error", or empty.
    std::string hint;     ///< Suggested action, or empty.

    /// The three texts as one: "where: message (hint)".
    std::string text() const;
};

/// Thrown by Result::value() if there is no value.
class Failure : public std::runtime_error {
  public:
    explicit Failure(Error error);
    ~Failure() override;

    const Error& error() const { return error_; }

  private:
    Error error_;
};

/// Throws a Failure.
[[noreturn]] void fail(const Error& error);

/// A value, or the error that prevented it. Functions of the library throw nothing; value() does.
template <class T>
class [[nodiscard]] Result {
  public:
    Result(T value) : content_(std::move(value)) {}
    Result(Error error) : content_(std::move(error)) {}

    /// True if there is a value.
    explicit operator bool() const { return std::holds_alternative<T>(content_); }
    /// The value, which must exist.
    T& operator*() { return std::get<T>(content_); }
    const T& operator*() const { return std::get<T>(content_); }
    T* operator->() { return &std::get<T>(content_); }
    const T* operator->() const { return &std::get<T>(content_); }
    /// The error, which must exist.
    const Error& error() const { return std::get<Error>(content_); }
    /// The value; throws a Failure if there is none.
    T value() && {
        if (!*this) fail(error());
        return std::move(**this);
    }
    const T& value() const& {
        if (!*this) fail(error());
        return **this;
    }

  private:
    std::variant<T, Error> content_;
};

/// Success, or the error that prevented it.
template <>
class [[nodiscard]] Result<void> {
  public:
    Result() = default;
    Result(Error error) : error_(std::move(error)), failed_(true) {}

    explicit operator bool() const { return !failed_; }
    const Error& error() const { return error_; }
    /// Throws a Failure unless it is a success.
    void value() const {
        if (failed_) fail(error_);
    }

  private:
    Error error_;
    bool failed_ = false;
};

}  // namespace exitance::api
