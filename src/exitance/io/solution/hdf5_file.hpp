#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "exitance/base/result.hpp"
#include "exitance/io/files/atomic_file.hpp"
#include "exitance/io/files/rehearsal.hpp"

namespace exitance {

/// The numbers that data sets hold.
enum class Hdf5Type { uint8, int32, uint32, int64, float32, float64, uint16 };

template <class T>
constexpr Hdf5Type hdf5_type() {
    if constexpr (std::is_same_v<T, std::uint8_t>) return Hdf5Type::uint8;
    if constexpr (std::is_same_v<T, std::uint16_t>) return Hdf5Type::uint16;
    if constexpr (std::is_same_v<T, std::int32_t>) return Hdf5Type::int32;
    if constexpr (std::is_same_v<T, std::uint32_t>) return Hdf5Type::uint32;
    if constexpr (std::is_same_v<T, std::int64_t>) return Hdf5Type::int64;
    if constexpr (std::is_same_v<T, float>) return Hdf5Type::float32;
    if constexpr (std::is_same_v<T, double>) return Hdf5Type::float64;
}

/// What a data set says about itself, as attributes.
struct Hdf5Label {
    const char* units;      ///< "m", "W/m^2" (see `Hdf5Writer::use_lumens`), or "1" for pure numbers.
    const char* long_name;  ///< A few words.
};

/// An HDF5 file in the making, which appears whole or not at all (AtomicFile). It is written as it grows, so that it
/// takes next to no memory; what the disk refuses is remembered by us, and not the library's to deal with. The same
/// calls give the same bytes: no times, no pointers. The first failure is remembered, what follows it does nothing, and
/// commit() reports it. One thread at a time.
class Hdf5Writer {
  public:
    explicit Hdf5Writer(const std::string& path);
    Hdf5Writer(const Hdf5Writer&) = delete;
    Hdf5Writer& operator=(const Hdf5Writer&) = delete;
    ~Hdf5Writer();

    /// Light is in lumens: from here on labels say lm where their units say W.
    void use_lumens() { in_lumens_ = true; }

    /// Groups are made before what goes into them. Names are paths from the root, "exitance/scene".
    void make_group(const std::string& name);

    /// Numbers in rows of `columns`; one column makes a one-dimensional set. Big sets are compressed (shuffled, gzip
    /// level 1) or carry a checksum, small ones stand in the header, under its checksum, so that a damaged file is
    /// noticed. All threads pack.
    template <class T>
    void write(const std::string& name, std::span<const T> values, std::size_t columns, Hdf5Label label) {
        write_numbers(name, values.data(), hdf5_type<T>(), values.size() / columns, columns, label);
    }
    template <class T>
    void write(const std::string& name, const std::vector<T>& values, std::size_t columns, Hdf5Label label) {
        write(name, std::span<const T>(values), columns, label);
    }
    /// The same where nobody holds them: make(i, row) writes row i, and is called for every i from 0 on in its order.
    template <class T, class Make>
    void write_rows(const std::string& name, std::size_t rows, std::size_t columns, Hdf5Label label, const Make& make) {
        write_blocks(name, hdf5_type<T>(), rows, columns, label, [&](std::size_t first, std::size_t count, void* out) {
            T* const values = static_cast<T*>(out);
            for (std::size_t i = 0; i < count; ++i) make(first + i, std::span<T>(values + i * columns, columns));
        });
    }
    void write_text(const std::string& name, std::string_view text, Hdf5Label label);
    /// Padded to the longest.
    void write_texts(const std::string& name, const std::vector<std::string>& texts, Hdf5Label label);

    void set_attribute(const std::string& object, const char* name, std::string_view text);
    template <class T>
    void set_attribute(const std::string& object, const char* name, std::span<const T> values) {
        set_numbers(object, name, values.data(), hdf5_type<T>(), values.size(), true);
    }
    template <class T>
    void set_attribute(const std::string& object, const char* name, const T& value) requires std::is_arithmetic_v<T> {
        set_numbers(object, name, &value, hdf5_type<T>(), 1, false);
    }

    /// The file is whole.
    Result<void> commit();

  private:
    using MakeBlock = std::function<void(std::size_t first, std::size_t count, void* out)>;
    void write_blocks(const std::string& name, Hdf5Type type, std::size_t rows, std::size_t columns, Hdf5Label label,
                      const MakeBlock& make);
    bool write_chunks(std::int64_t set, Hdf5Type type, std::size_t rows, std::size_t columns, const MakeBlock& make);
    void write_numbers(const std::string& name, const void* data, Hdf5Type type, std::size_t rows, std::size_t columns,
                       Hdf5Label label);
    void set_numbers(const std::string& object, const char* name, const void* data, Hdf5Type type, std::size_t count,
                     bool is_array);
    void write_set(const std::string& name, const void* data, std::int64_t memory_type, std::int64_t file_type,
                   std::span<const std::size_t> shape, std::size_t item_bytes, Hdf5Label label);
    std::int64_t make_set(const std::string& name, std::int64_t file_type, std::span<const std::size_t> shape,
                          std::size_t item_bytes);
    void describe(const std::string& name, Hdf5Label label);
    void set(std::int64_t object, const char* name, const void* data, std::int64_t type, std::int64_t space);
    void fail(const std::string& what);

    std::string path_;
    Result<AtomicFile> output_;
    std::int64_t file_ = -1;  ///< The library's handle.
    std::string failure_;
    bool in_lumens_ = false;
};

/// An HDF5 file that is read, and not trusted: sizes are compared with what the file really holds before anything is
/// allocated, and the library reads everything once in a process of its own before it does here. A function that fails
/// returns something empty and remembers the first failure, which names the file and the object; look at failed()
/// before using what was read. One thread at a time.
class Hdf5Reader {
  public:
    static Result<Hdf5Reader> open(const std::string& path, Rehearsed rehearsed = Rehearsed::not_yet);

    Hdf5Reader(Hdf5Reader&& other) noexcept
        : path_(std::move(other.path_)),
          file_(std::exchange(other.file_, -1)),
          bytes_(other.bytes_),
          error_(std::move(other.error_)) {}
    Hdf5Reader& operator=(Hdf5Reader&&) = delete;
    ~Hdf5Reader();

    bool has(const std::string& name) const;

    /// Rows of `columns` numbers; with `rows` given, just so many. Numbers are converted between widths, not between
    /// integers and fractions.
    template <class T>
    std::vector<T> read(const std::string& name, std::size_t columns = 1, std::optional<std::size_t> rows = {}) {
        std::vector<T> out;
        const std::optional<std::size_t> count = open_numbers(name, hdf5_type<T>(), columns, rows);
        if (count)
            out.resize(*count * columns), read_numbers(std::as_writable_bytes(std::span(out)), hdf5_type<T>(), columns);
        if (failed()) out.clear();
        return out;
    }
    std::string read_text(const std::string& name);
    std::vector<std::string> read_texts(const std::string& name, std::optional<std::size_t> count = {});

    /// Attributes; nothing when there is none of that name and kind, which is not a failure.
    std::optional<std::string> text_attribute(const std::string& object, const char* name);
    std::optional<double> number_attribute(const std::string& object, const char* name);
    std::optional<std::int64_t> integer_attribute(const std::string& object, const char* name);
    std::vector<std::string> attribute_names(const std::string& object);

    bool failed() const { return error_.has_value(); }
    const Error& error() const { return *error_; }
    /// Remembers that what was read from `name` makes no sense; `what` goes on from "data set NAME ".
    void fail(const std::string& name, const std::string& what);

  private:
    Hdf5Reader() = default;
    std::optional<std::size_t> open_numbers(const std::string& name, Hdf5Type type, std::size_t columns,
                                            std::optional<std::size_t> rows);
    void read_numbers(std::span<std::byte> out, Hdf5Type type, std::size_t columns);
    std::optional<std::int64_t> open_set(const std::string& name);

    std::string path_;
    std::int64_t file_ = -1;
    std::int64_t set_ = -1;  ///< Between open_numbers and read_numbers.
    std::string set_name_;
    std::uint64_t bytes_ = 0;  ///< Of the file.
    std::optional<Error> error_;
};

}  // namespace exitance
