#include <hdf5.h>

#include <algorithm>
#include <array>
#include <cstring>

#include "exitance/base/parallel.hpp"
#include "exitance/io/solution/hdf5_chunks.hpp"
#include "exitance/io/solution/hdf5_file.hpp"
#include "exitance/io/solution/hdf5_library.hpp"
#include "exitance/io/solution/hdf5_output.hpp"

namespace exitance {
namespace {

constexpr std::size_t chunk_bytes = 1 << 18;  ///< A quarter of the library's chunk cache.

hid_t text_type(std::size_t length, bool ascii) {
    const hid_t type = H5Tcopy(H5T_C_S1);
    H5Tset_size(type, std::max<std::size_t>(length, 1));
    H5Tset_strpad(type, H5T_STR_NULLPAD);
    H5Tset_cset(type, ascii ? H5T_CSET_ASCII : H5T_CSET_UTF8);
    return type;
}

/// Number of rows per chunk.
std::size_t rows_of_chunk(std::size_t row_bytes, std::size_t rows) {
    return std::clamp<std::size_t>(chunk_bytes / row_bytes, 1, std::max<std::size_t>(rows, 1));
}

bool is_ascii(std::string_view text) {
    return std::all_of(text.begin(), text.end(), [](char c) { return static_cast<unsigned char>(c) < 128; });
}

/// Uses the metadata layout of version 1.10, in which every block has a checksum.
hid_t file_access(AtomicFile& output) {
    const hid_t access = H5Pcreate(H5P_FILE_ACCESS);
    H5Pset_libver_bounds(access, H5F_LIBVER_V110, H5F_LIBVER_V110);
    H5Pset_fclose_degree(access, H5F_CLOSE_STRONG);
    set_hdf5_output(access, output);
    return access;
}

/// Stores no times; groups with few members are kept inside the header.
hid_t group_creation(hid_t of_class) {
    const hid_t creation = H5Pcreate(of_class);
    H5Pset_obj_track_times(creation, false);
    H5Pset_link_phase_change(creation, 64, 32);
    H5Pset_attr_phase_change(creation, 64, 32);
    return creation;
}

/// Packs chunks with all threads and writes them in order. `data`: rows from `row` on, whole chunks but for the last
/// rows of the set; is padded with zeros.
bool write_packed(std::int64_t set, const Hdf5Filters& filters, std::size_t row, std::size_t together,
                  std::size_t chunk_size, std::vector<std::byte>& data) {
    const std::size_t count = (data.size() + chunk_size - 1) / chunk_size;
    data.resize(count * chunk_size, std::byte{0});
    std::array<std::vector<std::byte>, hdf5_chunks_together> packed;
    parallel_for(count, 1,
                 [&](std::size_t k) { filters.pack(std::span(data).subspan(k * chunk_size, chunk_size), packed[k]); },
                 {"pack"});
    for (std::size_t k = 0; k < count; ++k) {
        const std::array<hsize_t, 2> at{row + k * together, 0};
        if (H5Dwrite_chunk(set, H5P_DEFAULT, 0, at.data(), packed[k].size(), packed[k].data()) < 0) return false;
    }
    return true;
}

}  // namespace

Hdf5Writer::Hdf5Writer(const std::string& path) : path_(path), output_(AtomicFile::create(path)) {
    if (!output_) {
        fail("the file");
        return;
    }
    quieten_hdf5();
    const Hdf5Handle access(file_access(*output_)), creation(group_creation(H5P_FILE_CREATE));
    file_ = H5Fcreate("exitance", H5F_ACC_TRUNC, creation, access);
    if (file_ < 0) fail("the file");
}

Hdf5Writer::~Hdf5Writer() {
    if (file_ >= 0) H5Fclose(file_);
}

void Hdf5Writer::fail(const std::string& what) {
    if (failure_.empty()) failure_ = "cannot make " + what + hdf5_says();
}

std::size_t Hdf5Writer::min_compressed_bytes() const {
    constexpr std::size_t usual = 4096, tight = 512;  // the header of a compressed set has about 100 bytes more
    return is_tight_ ? tight : usual;
}

void Hdf5Writer::make_group(const std::string& name) {
    if (!failure_.empty()) return;
    const Hdf5Handle creation(group_creation(H5P_GROUP_CREATE));
    const Hdf5Handle group(H5Gcreate2(file_, name.c_str(), H5P_DEFAULT, creation, H5P_DEFAULT));
    if (group < 0) fail("group " + name);
}

void Hdf5Writer::link(const std::string& name, const std::string& object) {
    if (!failure_.empty()) return;
    if (H5Lcreate_hard(file_, object.c_str(), file_, name.c_str(), H5P_DEFAULT, H5P_DEFAULT) < 0) fail("link " + name);
}

/// Creates a data set without values and returns its handle; negative on failure.
std::int64_t Hdf5Writer::make_set(const std::string& name, std::int64_t file_type, std::span<const std::size_t> shape,
                                  std::size_t item_bytes) {
    const int rank = static_cast<int>(shape.size());
    std::array<hsize_t, 2> extent{}, chunk{};
    std::size_t items = 1;
    for (std::size_t i = 0; i < shape.size(); ++i) extent[i] = chunk[i] = shape[i], items *= shape[i];

    const Hdf5Handle space(rank == 0 ? H5Screate(H5S_SCALAR) : H5Screate_simple(rank, extent.data(), nullptr));
    const Hdf5Handle creation(H5Pcreate(H5P_DATASET_CREATE));
    H5Pset_obj_track_times(creation, false);
    H5Pset_fill_time(creation, H5D_FILL_TIME_NEVER);
    if (items * item_bytes < min_compressed_bytes()) {
        // small data sets are stored in the header, whose checksum protects them
        if (items > 0) H5Pset_layout(creation, H5D_COMPACT);
    } else if (rank > 0) {
        chunk[0] = rows_of_chunk(items / shape[0] * item_bytes, shape[0]);
        H5Pset_chunk(creation, rank, chunk.data());
        // Light values (float32) get a checksum, since deflating them is slow and saves only a sixth if they have
        // different bands. These filters must agree with those of write_chunks() and flush().
        if (H5Tequal(file_type, hdf5_stored_type(Hdf5Type::float32)) > 0 && !deflates(Hdf5Type::float32)) {
            H5Pset_fletcher32(creation);
        } else {
            H5Pset_shuffle(creation);
            H5Pset_deflate(creation, 1);
        }
    }
    return H5Dcreate2(file_, name.c_str(), file_type, space, H5P_DEFAULT, creation, H5P_DEFAULT);
}

void Hdf5Writer::describe(const std::string& name, Hdf5Label label) {
    std::string units = label.units;
    if (in_lumens_)
        for (std::size_t at = 0; (at = units.find("W/", at)) != std::string::npos; at += 3) units.replace(at, 1, "lm");
    set_attribute(name, "units", std::string_view(units));
    set_attribute(name, "long_name", std::string_view(label.long_name));
}

void Hdf5Writer::write_set(const std::string& name, const void* data, std::int64_t memory_type, std::int64_t file_type,
                           std::span<const std::size_t> shape, std::size_t item_bytes, Hdf5Label label) {
    std::size_t items = 1;
    for (const std::size_t extent : shape) items *= extent;
    const Hdf5Handle set(make_set(name, file_type, shape, item_bytes));
    if (set < 0 || (items > 0 && H5Dwrite(set, memory_type, H5S_ALL, H5S_ALL, H5P_DEFAULT, data) < 0))
        return fail("data set " + name);
    describe(name, label);
}

/// Computes the rows of a few chunks at a time and writes them.
bool Hdf5Writer::write_chunks(std::int64_t set, Hdf5Type type, std::size_t rows, std::size_t columns,
                              const MakeBlock& make) {
    const Hdf5Filters filters{H5Tget_size(hdf5_native_type(type)), deflates(type)};
    const std::size_t row_bytes = columns * filters.item_bytes, together = rows_of_chunk(row_bytes, rows);
    std::vector<std::byte> made;
    for (std::size_t row = 0; row < rows; row += hdf5_chunks_together * together) {
        const std::size_t made_rows = std::min(rows - row, hdf5_chunks_together * together);
        made.resize(made_rows * row_bytes);
        make(row, made_rows, made.data());
        if (!write_packed(set, filters, row, together, together * row_bytes, made)) return false;
    }
    return true;
}

Hdf5Rows Hdf5Writer::open_rows(const std::string& name, Hdf5Type type, std::size_t rows, std::size_t columns,
                               Hdf5Label label) {
    Hdf5Rows out;
    out.name = name, out.type = type, out.rows = rows, out.columns = columns;
    if (!failure_.empty()) return out;
    const std::array<std::size_t, 2> extent = {rows, columns};
    out.set = make_set(name, hdf5_stored_type(type), std::span(extent).first(columns == 1 ? 1 : 2),
                       H5Tget_size(hdf5_native_type(type)));
    if (out.set < 0)
        fail("data set " + name);
    else
        describe(name, label);
    return out;
}

void Hdf5Writer::append(Hdf5Rows& set, std::span<const std::byte> rows) {
    if (set.set < 0 || !failure_.empty()) return;
    const std::size_t row_bytes = set.columns * H5Tget_size(hdf5_native_type(set.type)),
                      at_once = hdf5_chunks_together * rows_of_chunk(row_bytes, set.rows) * row_bytes;
    while (!rows.empty()) {
        const std::size_t taken = std::min(rows.size(), at_once - set.pending.size());
        set.pending.insert(set.pending.end(), rows.begin(), rows.begin() + static_cast<std::ptrdiff_t>(taken));
        rows = rows.subspan(taken);
        const bool is_complete = set.written * row_bytes + set.pending.size() == set.rows * row_bytes;
        if (set.pending.size() == at_once || is_complete) flush(set);
    }
}

/// Writes the pending rows, and closes the set after its last row.
void Hdf5Writer::flush(Hdf5Rows& set) {
    const Hdf5Filters filters{H5Tget_size(hdf5_native_type(set.type)), deflates(set.type)};
    const std::size_t row_bytes = set.columns * filters.item_bytes, count = set.pending.size() / row_bytes;
    const bool is_small = set.rows * row_bytes < min_compressed_bytes();
    const std::size_t together = rows_of_chunk(row_bytes, set.rows);
    const bool done =
        is_small ? H5Dwrite(set.set, hdf5_native_type(set.type), H5S_ALL, H5S_ALL, H5P_DEFAULT, set.pending.data()) >= 0
                 : write_packed(set.set, filters, set.written, together, together * row_bytes, set.pending);
    if (!done) fail("data set " + set.name);
    set.written += count, set.pending.clear();
    if (set.written == set.rows) H5Idec_ref(std::exchange(set.set, -1));
}

void Hdf5Writer::write_blocks(const std::string& name, Hdf5Type type, std::size_t rows, std::size_t columns,
                              Hdf5Label label, const MakeBlock& make) {
    if (!failure_.empty()) return;
    const std::array<std::size_t, 2> extent = {rows, columns};
    const std::size_t item_bytes = H5Tget_size(hdf5_native_type(type)), bytes = rows * columns * item_bytes;
    const Hdf5Handle set(
        make_set(name, hdf5_stored_type(type), std::span(extent).first(columns == 1 ? 1 : 2), item_bytes));
    bool is_written = set >= 0;
    if (is_written && bytes >= min_compressed_bytes()) {
        is_written = write_chunks(set, type, rows, columns, make);
    } else if (is_written && bytes > 0) {
        std::vector<std::byte> all(bytes);
        make(0, rows, all.data());
        is_written = H5Dwrite(set, hdf5_native_type(type), H5S_ALL, H5S_ALL, H5P_DEFAULT, all.data()) >= 0;
    }
    if (!is_written) return fail("data set " + name);
    describe(name, label);
}

void Hdf5Writer::write_numbers(const std::string& name, const void* data, Hdf5Type type, std::size_t rows,
                               std::size_t columns, Hdf5Label label) {
    const std::size_t row_bytes = columns * H5Tget_size(hdf5_native_type(type));
    write_blocks(name, type, rows, columns, label, [&](std::size_t first, std::size_t count, void* out) {
        std::memcpy(out, static_cast<const std::byte*>(data) + first * row_bytes, count * row_bytes);
    });
}

void Hdf5Writer::write_text(const std::string& name, std::string_view text, Hdf5Label label) {
    if (!failure_.empty()) return;
    const std::string padded = text.empty() ? std::string(1, '\0') : std::string(text);
    const Hdf5Handle type(text_type(padded.size(), is_ascii(text)));
    write_set(name, padded.data(), type, type, {}, padded.size(), label);
}

void Hdf5Writer::write_texts(const std::string& name, const std::vector<std::string>& texts, Hdf5Label label) {
    if (!failure_.empty()) return;
    std::size_t longest = 1;
    bool ascii = true;
    for (const std::string& text : texts) longest = std::max(longest, text.size()), ascii = ascii && is_ascii(text);
    std::string padded(longest * texts.size(), '\0');
    for (std::size_t i = 0; i < texts.size(); ++i) texts[i].copy(padded.data() + i * longest, longest);
    const Hdf5Handle type(text_type(longest, ascii));
    const std::size_t shape[1] = {texts.size()};
    write_set(name, padded.data(), type, type, shape, longest, label);
}

void Hdf5Writer::set(std::int64_t object, const char* name, const void* data, std::int64_t type, std::int64_t space) {
    const Hdf5Handle attribute(H5Acreate2(object, name, type, space, H5P_DEFAULT, H5P_DEFAULT));
    if (attribute < 0 || H5Awrite(attribute, type, data) < 0) fail("attribute " + std::string(name));
}

void Hdf5Writer::set_attribute(const std::string& object, const char* name, std::string_view text) {
    if (!failure_.empty()) return;
    const std::string padded = text.empty() ? std::string(1, '\0') : std::string(text);
    const Hdf5Handle target(H5Oopen(file_, object.c_str(), H5P_DEFAULT)), space(H5Screate(H5S_SCALAR));
    const Hdf5Handle type(text_type(padded.size(), is_ascii(text)));
    set(target, name, padded.data(), type, space);
}

void Hdf5Writer::set_numbers(const std::string& object, const char* name, const void* data, Hdf5Type type,
                             std::size_t count, bool is_array) {
    if (!failure_.empty()) return;
    const hsize_t extent = count;
    const Hdf5Handle target(H5Oopen(file_, object.c_str(), H5P_DEFAULT));
    const Hdf5Handle space(is_array ? H5Screate_simple(1, &extent, nullptr) : H5Screate(H5S_SCALAR));
    set(target, name, data, hdf5_native_type(type), space);
}

Result<void> Hdf5Writer::commit() {
    if (!output_) return output_.error();
    if (file_ >= 0 && H5Fclose(std::exchange(file_, -1)) < 0) fail("the file");
    // Report a disk error first, since it may have caused a failure of the library.
    const Result<void> written = failure_.empty() || output_->failed() ? output_->commit() : Result<void>();
    if (!written) return written;
    if (!failure_.empty()) return Error{ErrorCode::cannot_write, "cannot be written: " + failure_, path_, ""};
    return {};
}

}  // namespace exitance
