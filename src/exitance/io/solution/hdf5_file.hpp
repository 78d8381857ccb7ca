#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "exitance/base/half.hpp"
#include "exitance/base/result.hpp"
#include "exitance/io/files/atomic_file.hpp"
#include "exitance/io/files/rehearsal.hpp"

namespace exitance {

/// Number types of data sets.
enum class Hdf5Type { uint8, int32, uint32, int64, float32, float64, uint16, float16 };

template <class T>
constexpr Hdf5Type hdf5_type() {
    if constexpr (std::is_same_v<T, std::uint8_t>) return Hdf5Type::uint8;
    if constexpr (std::is_same_v<T, std::uint16_t>) return Hdf5Type::uint16;
    if constexpr (std::is_same_v<T, std::int32_t>) return Hdf5Type::int32;
    if constexpr (std::is_same_v<T, std::uint32_t>) return Hdf5Type::uint32;
    if constexpr (std::is_same_v<T, std::int64_t>) return Hdf5Type::int64;
    if constexpr (std::is_same_v<T, Half>) return Hdf5Type::float16;
    if constexpr (std::is_same_v<T, float>) return Hdf5Type::float32;
    if constexpr (std::is_same_v<T, double>) return Hdf5Type::float64;
}

/// Description of a data set, stored as attributes.
struct Hdf5Label {
    const char* units;      ///< "m", "W/m^2" (see `Hdf5Writer::use_lumens`), or "1" for dimensionless numbers.
    const char* long_name;  ///< Description in a few words.
};

/// A data set whose rows arrive one after the other, see Hdf5Writer::open_rows().
struct Hdf5Rows {
    std::int64_t set = -1;  ///< Handle of the library.
    std::string name;
    Hdf5Type type = Hdf5Type::float32;
    std::size_t rows = 0, columns = 0;
    std::size_t written = 0;         ///< Rows in the file.
    std::vector<std::byte> pending;  ///< Rows that do not fill the chunks that are packed together.
};

/// Writes an HDF5 file, which appears whole or not at all (see AtomicFile). Data are written as they arrive, in little
/// memory. Equal calls give equal bytes: the file contains no times and no pointers. After the first failure further
/// calls do nothing, and commit() reports it. Disk errors are handled by AtomicFile, not by the library. One thread at
/// a time.
class Hdf5Writer {
  public:
    explicit Hdf5Writer(const std::string& path);
    Hdf5Writer(const Hdf5Writer&) = delete;
    Hdf5Writer& operator=(const Hdf5Writer&) = delete;
    ~Hdf5Writer();

    /// Declares light to be in lumens: from now on, W in the units of labels becomes lm.
    void use_lumens() { in_lumens_ = true; }

    /// From now on, compresses light values and small sets as well, which takes more time.
    void pack_tightly() { is_tight_ = true; }

    /// Creates a group. It must exist before its members are written. Names are paths from the root, such as
    /// "exitance/scene".
    void make_group(const std::string& name);
    /// Gives an object a second name, under which readers find the same object.
    void link(const std::string& name, const std::string& object);

    /// Writes numbers in rows of `columns`; with one column, the set is one-dimensional. Large sets are compressed
    /// (shuffled, gzip level 1) or have a checksum; small ones are in the header, under its checksum, so that damage is
    /// detected. All threads pack chunks.
    template <class T>
    void write(const std::string& name, std::span<const T> values, std::size_t columns, Hdf5Label label) {
        write_numbers(name, values.data(), hdf5_type<T>(), values.size() / columns, columns, label);
    }
    template <class T>
    void write(const std::string& name, const std::vector<T>& values, std::size_t columns, Hdf5Label label) {
        write(name, std::span<const T>(values), columns, label);
    }
    /// Writes rows that need not be in memory: make(i, row) computes row i and is called for every i in ascending
    /// order.
    template <class T, class Make>
    void write_rows(const std::string& name, std::size_t rows, std::size_t columns, Hdf5Label label, const Make& make) {
        write_blocks(name, hdf5_type<T>(), rows, columns, label, [&](std::size_t first, std::size_t count, void* out) {
            T* const values = static_cast<T*>(out);
            for (std::size_t i = 0; i < count; ++i) make(first + i, std::span<T>(values + i * columns, columns));
        });
    }
    /// Creates a data set whose rows append() adds later; several sets may be open at a time. Memory: 4 MB per set.
    template <class T>
    Hdf5Rows open_rows(const std::string& name, std::size_t rows, std::size_t columns, Hdf5Label label) {
        return open_rows(name, hdf5_type<T>(), rows, columns, label);
    }
    /// Adds whole rows of the set's type. All rows must be added before commit().
    template <class T>
    void append(Hdf5Rows& set, std::span<const T> values) {
        append(set, std::as_bytes(values));
    }
    void write_text(const std::string& name, std::string_view text, Hdf5Label label);
    /// Pads the texts to the length of the longest.
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

    /// Completes the file.
    Result<void> commit();

  private:
    using MakeBlock = std::function<void(std::size_t first, std::size_t count, void* out)>;
    void write_blocks(const std::string& name, Hdf5Type type, std::size_t rows, std::size_t columns, Hdf5Label label,
                      const MakeBlock& make);
    Hdf5Rows open_rows(const std::string& name, Hdf5Type type, std::size_t rows, std::size_t columns, Hdf5Label label);
    void append(Hdf5Rows& set, std::span<const std::byte> rows);
    void flush(Hdf5Rows& set);
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
    /// Data sets of at least this size are compressed, bytes.
    std::size_t min_compressed_bytes() const;
    /// True if large sets of a type are deflated. Others get a checksum.
    bool deflates(Hdf5Type type) const { return is_tight_ || type != Hdf5Type::float32; }
    void set(std::int64_t object, const char* name, const void* data, std::int64_t type, std::int64_t space);
    void fail(const std::string& what);

    std::string path_;
    Result<AtomicFile> output_;
    std::int64_t file_ = -1;  ///< Handle of the library.
    std::string failure_;
    bool in_lumens_ = false, is_tight_ = false;
};

/// Reads an HDF5 file that may be damaged or malicious. Sizes are compared with the actual content of the file before
/// memory is allocated, and the library first reads the whole file in a separate process. A function that fails returns
/// an empty result and stores the first error, which names the file and the object; check failed() before using
/// results. One thread at a time.
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

    /// Reads rows of `columns` numbers; exactly `rows` if given. Integers are converted to integers of other widths and
    /// floating-point numbers to others, but not one to the other.
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

    /// Return an attribute; empty if there is none with that name and type, which is not an error.
    std::optional<std::string> text_attribute(const std::string& object, const char* name);
    std::optional<double> number_attribute(const std::string& object, const char* name);
    std::optional<std::int64_t> integer_attribute(const std::string& object, const char* name);
    std::vector<std::string> attribute_names(const std::string& object);

    bool failed() const { return error_.has_value(); }
    const Error& error() const { return *error_; }
    /// Reports that the content of data set `name` is invalid. `what` continues the sentence "data set NAME ".
    void fail(const std::string& name, const std::string& what);

  private:
    Hdf5Reader() = default;
    std::optional<std::size_t> open_numbers(const std::string& name, Hdf5Type type, std::size_t columns,
                                            std::optional<std::size_t> rows);
    void read_numbers(std::span<std::byte> out, Hdf5Type type, std::size_t columns);
    std::optional<std::int64_t> open_set(const std::string& name);

    std::string path_;
    std::int64_t file_ = -1;
    std::int64_t set_ = -1;  ///< Open data set, between open_numbers() and read_numbers().
    std::string set_name_;
    std::uint64_t bytes_ = 0;  ///< Size of the file.
    std::optional<Error> error_;
};

}  // namespace exitance
