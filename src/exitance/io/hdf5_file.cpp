#include "exitance/io/hdf5_file.hpp"

#include <hdf5.h>
#include <sys/stat.h>

#include <algorithm>
#include <array>
#include <cstring>
#include <new>
#include <set>

#include "exitance/io/atomic_file.hpp"
#include "exitance/io/hdf5_checksum.hpp"
#include "exitance/io/rehearsal.hpp"

namespace exitance {
namespace {

constexpr std::size_t big_bytes = 4096;         ///< From here on compression pays.
constexpr std::size_t chunk_bytes = 1 << 18;    ///< A quarter of the library's cache of chunks.
constexpr std::size_t largest_chunk = 1 << 26;  ///< That we agree to read.
constexpr std::size_t largest_text = 1 << 26;
constexpr double gzip_at_best = 1100;  ///< Deflate cannot shrink more than 1032 times.

/// A handle of the library, given back at the end of its scope. Negative when what made it failed.
class Handle {
  public:
    explicit Handle(hid_t id) : id_(id) {}
    Handle(const Handle&) = delete;
    Handle& operator=(const Handle&) = delete;
    ~Handle() {
        if (id_ >= 0) H5Idec_ref(id_);
    }
    operator hid_t() const { return id_; }

  private:
    hid_t id_;
};

hid_t native(Hdf5Type type) {
    switch (type) {
        case Hdf5Type::uint8:
            return H5T_NATIVE_UINT8;
        case Hdf5Type::int32:
            return H5T_NATIVE_INT32;
        case Hdf5Type::uint32:
            return H5T_NATIVE_UINT32;
        case Hdf5Type::int64:
            return H5T_NATIVE_INT64;
        case Hdf5Type::float32:
            return H5T_NATIVE_FLOAT;
        case Hdf5Type::float64:
            break;
    }
    return H5T_NATIVE_DOUBLE;
}

/// Little-endian in the file, wherever it is written.
hid_t stored(Hdf5Type type) {
    switch (type) {
        case Hdf5Type::uint8:
            return H5T_STD_U8LE;
        case Hdf5Type::int32:
            return H5T_STD_I32LE;
        case Hdf5Type::uint32:
            return H5T_STD_U32LE;
        case Hdf5Type::int64:
            return H5T_STD_I64LE;
        case Hdf5Type::float32:
            return H5T_IEEE_F32LE;
        case Hdf5Type::float64:
            break;
    }
    return H5T_IEEE_F64LE;
}

hid_t text_type(std::size_t length, bool ascii) {
    const hid_t type = H5Tcopy(H5T_C_S1);
    H5Tset_size(type, std::max<std::size_t>(length, 1));
    H5Tset_strpad(type, H5T_STR_NULLPAD);
    H5Tset_cset(type, ascii ? H5T_CSET_ASCII : H5T_CSET_UTF8);
    return type;
}

bool is_ascii(std::string_view text) {
    return std::all_of(text.begin(), text.end(), [](char c) { return static_cast<unsigned char>(c) < 128; });
}

/// The library's own words for the failure at hand, as far down as they go.
std::string library_says() {
    std::string words;
    const auto visit = [](unsigned, const H5E_error2_t* error, void* out) -> herr_t {
        if (error->desc) *static_cast<std::string*>(out) = error->desc;
        return 0;
    };
    H5Ewalk2(H5E_DEFAULT, H5E_WALK_DOWNWARD, visit, &words);
    return words.empty() ? "" : " (" + words + ")";
}

void quieten_library() {
    H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr);
}

/// Metadata in the layout of version 1.10: every block of it carries a checksum.
hid_t file_access() {
    const hid_t access = H5Pcreate(H5P_FILE_ACCESS);
    H5Pset_libver_bounds(access, H5F_LIBVER_V110, H5F_LIBVER_V110);
    H5Pset_fclose_degree(access, H5F_CLOSE_STRONG);
    return access;
}

/// No times; few members stay inside the header.
hid_t group_creation(hid_t of_class) {
    const hid_t creation = H5Pcreate(of_class);
    H5Pset_obj_track_times(creation, false);
    H5Pset_link_phase_change(creation, 64, 32);
    H5Pset_attr_phase_change(creation, 64, 32);
    return creation;
}

/// An image still has its superblock's checksum from when the file was open for writing: version 1.10 of the library
/// clears that mark in the image, and forgets the checksum.
void mend_superblock(std::string& image) {
    constexpr std::size_t version_at = 8, checksum_at = 44;
    if (image.size() < checksum_at + 4 || image[version_at] != 3) return;
    const std::uint32_t sum = hdf5_checksum(std::string_view(image).substr(0, checksum_at));
    for (std::size_t k = 0; k < 4; ++k) image[checksum_at + k] = static_cast<char>(sum >> 8 * k & 0xff);
}

}  // namespace

Hdf5Writer::Hdf5Writer() {
    quieten_library();
    const Handle access(file_access()), creation(group_creation(H5P_FILE_CREATE));
    H5Pset_fapl_core(access, 1 << 20, false);
    file_ = H5Fcreate("exitance", H5F_ACC_TRUNC, creation, access);
    if (file_ < 0) fail("the file");
}

Hdf5Writer::~Hdf5Writer() {
    if (file_ >= 0) H5Fclose(file_);
}

void Hdf5Writer::fail(const std::string& what) {
    if (failure_.empty()) failure_ = "cannot make " + what + library_says();
}

void Hdf5Writer::make_group(const std::string& name) {
    if (!failure_.empty()) return;
    const Handle creation(group_creation(H5P_GROUP_CREATE));
    const Handle group(H5Gcreate2(file_, name.c_str(), H5P_DEFAULT, creation, H5P_DEFAULT));
    if (group < 0) fail("group " + name);
}

void Hdf5Writer::write_set(const std::string& name, const void* data, std::int64_t memory_type, std::int64_t file_type,
                           std::span<const std::size_t> shape, std::size_t item_bytes, Hdf5Label label) {
    const int rank = static_cast<int>(shape.size());
    std::array<hsize_t, 2> extent{}, chunk{};
    std::size_t items = 1;
    for (std::size_t i = 0; i < shape.size(); ++i) extent[i] = chunk[i] = shape[i], items *= shape[i];

    const Handle space(rank == 0 ? H5Screate(H5S_SCALAR) : H5Screate_simple(rank, extent.data(), nullptr));
    const Handle creation(H5Pcreate(H5P_DATASET_CREATE));
    H5Pset_obj_track_times(creation, false);
    H5Pset_fill_time(creation, H5D_FILL_TIME_NEVER);
    if (items * item_bytes < big_bytes) {
        if (items > 0) H5Pset_layout(creation, H5D_COMPACT);  // in the header, under its checksum
    } else if (rank > 0) {
        const std::size_t row_bytes = items / shape[0] * item_bytes;
        chunk[0] = std::clamp<hsize_t>(chunk_bytes / row_bytes, 1, extent[0]);
        H5Pset_chunk(creation, rank, chunk.data());
        // The digits of light do not shrink: deflating them takes long and gains a sixth. They get a checksum instead.
        if (H5Tequal(file_type, stored(Hdf5Type::float32)) > 0) {
            H5Pset_fletcher32(creation);
        } else {
            H5Pset_shuffle(creation);
            H5Pset_deflate(creation, 1);
        }
    }
    const Handle set(H5Dcreate2(file_, name.c_str(), file_type, space, H5P_DEFAULT, creation, H5P_DEFAULT));
    if (set < 0 || (items > 0 && H5Dwrite(set, memory_type, H5S_ALL, H5S_ALL, H5P_DEFAULT, data) < 0))
        return fail("data set " + name);
    set_attribute(name, "units", std::string_view(label.units));
    set_attribute(name, "long_name", std::string_view(label.long_name));
}

void Hdf5Writer::write_numbers(const std::string& name, const void* data, Hdf5Type type, std::size_t rows,
                               std::size_t columns, Hdf5Label label) {
    if (!failure_.empty()) return;
    const std::array<std::size_t, 2> shape = {rows, columns};
    write_set(name, data, native(type), stored(type), std::span(shape).first(columns == 1 ? 1 : 2),
              H5Tget_size(native(type)), label);
}

void Hdf5Writer::write_text(const std::string& name, std::string_view text, Hdf5Label label) {
    if (!failure_.empty()) return;
    const std::string padded = text.empty() ? std::string(1, '\0') : std::string(text);
    const Handle type(text_type(padded.size(), is_ascii(text)));
    write_set(name, padded.data(), type, type, {}, padded.size(), label);
}

void Hdf5Writer::write_texts(const std::string& name, const std::vector<std::string>& texts, Hdf5Label label) {
    if (!failure_.empty()) return;
    std::size_t longest = 1;
    bool ascii = true;
    for (const std::string& text : texts) longest = std::max(longest, text.size()), ascii = ascii && is_ascii(text);
    std::string padded(longest * texts.size(), '\0');
    for (std::size_t i = 0; i < texts.size(); ++i) texts[i].copy(padded.data() + i * longest, longest);
    const Handle type(text_type(longest, ascii));
    const std::size_t shape[1] = {texts.size()};
    write_set(name, padded.data(), type, type, shape, longest, label);
}

void Hdf5Writer::set(std::int64_t object, const char* name, const void* data, std::int64_t type, std::int64_t space) {
    const Handle attribute(H5Acreate2(object, name, type, space, H5P_DEFAULT, H5P_DEFAULT));
    if (attribute < 0 || H5Awrite(attribute, type, data) < 0) fail("attribute " + std::string(name));
}

void Hdf5Writer::set_attribute(const std::string& object, const char* name, std::string_view text) {
    if (!failure_.empty()) return;
    const std::string padded = text.empty() ? std::string(1, '\0') : std::string(text);
    const Handle target(H5Oopen(file_, object.c_str(), H5P_DEFAULT)), space(H5Screate(H5S_SCALAR));
    const Handle type(text_type(padded.size(), is_ascii(text)));
    set(target, name, padded.data(), type, space);
}

void Hdf5Writer::set_numbers(const std::string& object, const char* name, const void* data, Hdf5Type type,
                             std::size_t count, bool is_array) {
    if (!failure_.empty()) return;
    const hsize_t extent = count;
    const Handle target(H5Oopen(file_, object.c_str(), H5P_DEFAULT));
    const Handle space(is_array ? H5Screate_simple(1, &extent, nullptr) : H5Screate(H5S_SCALAR));
    set(target, name, data, native(type), space);
}

Result<void> Hdf5Writer::write_file(const std::string& path) {
    std::string image;
    if (failure_.empty()) {
        if (H5Fflush(file_, H5F_SCOPE_GLOBAL) < 0) fail("the file");
        const ssize_t size = H5Fget_file_image(file_, nullptr, 0);
        if (size > 0) image.resize(static_cast<std::size_t>(size));
        if (size <= 0 || H5Fget_file_image(file_, image.data(), image.size()) != size) fail("the file");
        mend_superblock(image);
    }
    if (!failure_.empty()) return Error{ErrorCode::cannot_write, "cannot be written: " + failure_, path, ""};
    return exitance::write_file(path, image);
}

namespace {

bool is_fixed_text(hid_t type) {
    return H5Tget_class(type) == H5T_STRING && H5Tis_variable_str(type) == 0;
}

/// A number whose bits all count, in the order of some machine; others are converted by little-trodden ways.
bool is_plain_number(hid_t type) {
    if (H5Tget_class(type) == H5T_INTEGER) return H5Tget_precision(type) == 8 * H5Tget_size(type);
    for (const hid_t known : {H5T_IEEE_F32LE, H5T_IEEE_F64LE, H5T_IEEE_F32BE, H5T_IEEE_F64BE})
        if (H5Tequal(type, known) > 0) return true;
    return false;
}

/// What reading a file may take at a time: what is written shrinks little, since most of it are digits of light.
constexpr std::size_t room_for(std::uint64_t file_bytes) {
    return 10 * static_cast<std::size_t>(file_bytes) + (std::size_t{64} << 20);
}

/// May a set of so many items be read: do the bytes that the file holds for it make so many, after unpacking, and are
/// they no more than a file of this size may ask for, 8 bytes each at most?
bool holds_really(hid_t set, std::size_t item_bytes, std::size_t items, std::uint64_t file_bytes) {
    const Handle creation(H5Dget_create_plist(set));
    const H5D_layout_t layout = H5Pget_layout(creation);
    if (layout != H5D_COMPACT && layout != H5D_CONTIGUOUS && layout != H5D_CHUNKED) return false;
    if (H5Pget_external_count(creation) > 0) return false;
    double grows = 1;
    if (layout == H5D_CHUNKED) {
        std::array<hsize_t, 2> chunk{};
        const int rank = H5Pget_chunk(creation, 2, chunk.data());
        if (rank < 1 || rank > 2) return false;
        double bytes = static_cast<double>(item_bytes);
        for (hsize_t extent : chunk) bytes *= static_cast<double>(std::max<hsize_t>(extent, 1));
        if (bytes > static_cast<double>(largest_chunk)) return false;
        if (H5Pget_nfilters(creation) > 0) grows = gzip_at_best;
    }
    const hsize_t held = H5Dget_storage_size(set);
    if (items > room_for(file_bytes) / std::max<std::size_t>(item_bytes, 8)) return false;
    return held <= file_bytes &&
           static_cast<double>(items) * static_cast<double>(item_bytes) <= grows * static_cast<double>(held);
}

/// Reads every data set and attribute of solutions, as they stand in the file, into the same buffer.
class Rehearsal {
  public:
    explicit Rehearsal(std::uint64_t file_bytes) : file_bytes_(file_bytes) {}

    /// Could everything be opened? What fails the first time is not always refused the next time, half made as it is.
    bool read(hid_t file) { return H5Lexists(file, "exitance", H5P_DEFAULT) <= 0 || object(file, "exitance"); }

  private:
    /// How many items of a kind that we read, or none.
    static std::size_t items_of(hid_t type, hid_t space) {
        const hssize_t count = H5Sget_simple_extent_npoints(space);
        const bool known = H5Tget_size(type) > 0 && (is_fixed_text(type) || is_plain_number(type));
        return count > 0 && known ? static_cast<std::size_t>(count) : 0;
    }

    char* room(std::size_t bytes) {
        if (buffer_.size() < bytes) {
            buffer_ = {};  // given back before more is taken
            buffer_.resize(bytes);
        }
        return buffer_.data();
    }

    bool attribute(hid_t object, const char* name) {
        const Handle attribute(H5Aopen(object, name, H5P_DEFAULT));
        if (attribute < 0) return false;
        const Handle type(H5Aget_type(attribute)), space(H5Aget_space(attribute));
        const std::size_t items = items_of(type, space), size = H5Tget_size(type);
        if (items > 0 && items <= file_bytes_ / size) H5Aread(attribute, type, room(items * size));
        return true;
    }

    bool attributes(hid_t object) {
        const auto visit = [](hid_t at, const char* name, const H5A_info_t*, void* self) -> herr_t {
            return static_cast<Rehearsal*>(self)->attribute(at, name) ? 0 : -1;
        };
        hsize_t position = 0;
        return H5Aiterate2(object, H5_INDEX_NAME, H5_ITER_INC, &position, visit, this) >= 0;
    }

    bool members(hid_t group) {
        const auto visit = [](hid_t from, const char* link, const H5L_info_t*, void* self) -> herr_t {
            return static_cast<Rehearsal*>(self)->object(from, link) ? 0 : -1;
        };
        hsize_t position = 0;
        return H5Literate(group, H5_INDEX_NAME, H5_ITER_INC, &position, visit, this) >= 0;
    }

    bool numbers(hid_t set) {
        const Handle type(H5Dget_type(set)), space(H5Dget_space(set));
        if (type < 0 || space < 0) return false;
        const std::size_t items = items_of(type, space), size = H5Tget_size(type);
        if (items > 0 && holds_really(set, size, items, file_bytes_))
            H5Dread(set, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, room(items * size));
        return true;
    }

    /// An object and all below it.
    bool object(hid_t from, const char* name) {
        const Handle object(H5Oopen(from, name, H5P_DEFAULT));
        H5O_info_t info;
        if (object < 0 || H5Oget_info2(object, &info, H5O_INFO_BASIC) < 0) return false;
        if (!seen_.insert(info.addr).second) return true;
        if (!attributes(object)) return false;
        if (info.type == H5O_TYPE_GROUP) return members(object);
        return info.type != H5O_TYPE_DATASET || numbers(object);
    }

    std::uint64_t file_bytes_;
    std::vector<char> buffer_;
    std::set<haddr_t> seen_;  ///< Addresses of objects: links may lead back.
};

/// Remembers whether the library got less memory than it asked for. It says so where a call fails, and only there.
class MemoryWatch {
  public:
    MemoryWatch() { H5Eset_auto2(H5E_DEFAULT, look, &lacking_); }
    ~MemoryWatch() { quieten_library(); }
    bool lacking() const { return lacking_; }

  private:
    static herr_t look(hid_t errors, void* lacking) {
        const auto visit = [](unsigned, const H5E_error2_t* error, void* out) -> herr_t {
            if (error->min_num == H5E_NOSPACE || error->min_num == H5E_CANTALLOC) *static_cast<bool*>(out) = true;
            return 0;
        };
        return H5Ewalk2(errors, H5E_WALK_DOWNWARD, visit, lacking);
    }

    bool lacking_ = false;
};

/// The library takes bytes on trust that are damaged on purpose: their checksums are right. It does so first where
/// nothing is lost.
std::optional<Error> rehearse_reading(const std::string& path, std::uint64_t bytes, hid_t access) {
    const auto failed = rehearse(
        [&] {
            const MemoryWatch memory;
            const hid_t file = H5Fopen(path.c_str(), H5F_ACC_RDONLY, access);
            const bool whole = file < 0 || Rehearsal(bytes).read(file);
            if (memory.lacking()) throw std::bad_alloc();
            if (file >= 0) H5Fclose(file);
            return whole;
        },
        2 + 1e-7 * static_cast<double>(bytes), room_for(bytes));
    if (!failed) return {};
    return Error{ErrorCode::bad_input, "is damaged: the HDF5 library " + *failed + " when it reads this file", path,
                 "solve the scene again with this program"};
}

}  // namespace

Result<Hdf5Reader> Hdf5Reader::open(const std::string& path) {
    quieten_library();
    struct stat present;
    if (::stat(path.c_str(), &present) != 0)
        return Error{ErrorCode::cannot_read, std::string("cannot be read: ") + std::strerror(errno), path, ""};
    if (S_ISDIR(present.st_mode)) return Error{ErrorCode::cannot_read, "is a folder", path, ""};
    const Handle access(H5Pcreate(H5P_FILE_ACCESS));
    H5Pset_fclose_degree(access, H5F_CLOSE_STRONG);
    if (const auto damage = rehearse_reading(path, static_cast<std::uint64_t>(present.st_size), access)) return *damage;
    Hdf5Reader out;
    out.path_ = path;
    out.bytes_ = static_cast<std::uint64_t>(present.st_size);
    out.file_ = H5Fopen(path.c_str(), H5F_ACC_RDONLY, access);
    if (out.file_ < 0)
        return Error{ErrorCode::bad_input, "is not an HDF5 file, or a damaged one" + library_says(), path,
                     "solutions are the .h5 files that `exitance solve` writes"};
    return out;
}

Hdf5Reader::~Hdf5Reader() {
    if (set_ >= 0) H5Idec_ref(set_);
    if (file_ >= 0) H5Fclose(file_);
}

void Hdf5Reader::fail(const std::string& name, const std::string& what) {
    if (!error_) error_ = Error{ErrorCode::bad_input, "data set " + name + " " + what, path_, ""};
}

bool Hdf5Reader::has(const std::string& name) const {
    // Every part of the path has to be there before the library may be asked for the next.
    for (std::size_t end = name.find('/');; end = name.find('/', end + 1)) {
        if (H5Lexists(file_, name.substr(0, end).c_str(), H5P_DEFAULT) <= 0) return false;
        if (end == std::string::npos) return true;
    }
}

std::optional<std::int64_t> Hdf5Reader::open_set(const std::string& name) {
    if (failed()) return {};
    if (!has(name)) return fail(name, "is missing"), std::nullopt;
    const hid_t set = H5Dopen2(file_, name.c_str(), H5P_DEFAULT);
    if (set < 0) return fail(name, "cannot be opened" + library_says()), std::nullopt;
    return set;
}

std::optional<std::size_t> Hdf5Reader::open_numbers(const std::string& name, Hdf5Type type, std::size_t columns,
                                                    std::optional<std::size_t> rows) {
    const std::optional<std::int64_t> set = open_set(name);
    if (!set) return {};
    if (set_ >= 0) H5Idec_ref(set_);
    set_ = *set, set_name_ = name;
    const Handle space(H5Dget_space(set_)), held(H5Dget_type(set_));
    const bool fraction = type == Hdf5Type::float32 || type == Hdf5Type::float64;
    if (H5Tget_class(held) != (fraction ? H5T_FLOAT : H5T_INTEGER) || !is_plain_number(held))
        return fail(name, fraction ? "does not hold fractions" : "does not hold integers"), std::nullopt;
    const int rank = H5Sget_simple_extent_ndims(space), wanted = columns == 1 ? 1 : 2;
    std::array<hsize_t, 2> extent = {0, 1};
    if (rank != wanted || H5Sget_simple_extent_dims(space, extent.data(), nullptr) != wanted || extent[1] != columns)
        return fail(name, "does not have rows of " + std::to_string(columns)), std::nullopt;
    if (rows && extent[0] != *rows)
        return fail(name, "has " + std::to_string(extent[0]) + " rows in place of " + std::to_string(*rows)),
               std::nullopt;
    if (extent[0] >= (std::uint64_t{1} << 40) || !holds_really(set_, H5Tget_size(held), extent[0] * columns, bytes_))
        return fail(name, "claims " + std::to_string(extent[0]) + " rows, more than the file holds"), std::nullopt;
    return extent[0];
}

void Hdf5Reader::read_numbers(void* out, Hdf5Type type) {
    if (H5Dread(set_, native(type), H5S_ALL, H5S_ALL, H5P_DEFAULT, out) < 0)
        fail(set_name_, "cannot be read" + library_says());
}

std::string Hdf5Reader::read_text(const std::string& name) {
    const std::optional<std::int64_t> opened = open_set(name);
    if (!opened) return {};
    const Handle set(*opened), space(H5Dget_space(set)), type(H5Dget_type(set));
    const std::size_t length = H5Tget_size(type);
    if (!is_fixed_text(type) || H5Sget_simple_extent_npoints(space) != 1)
        return fail(name, "is not one text of fixed length"), "";
    if (length > largest_text || !holds_really(set, length, 1, bytes_))
        return fail(name, "claims a text longer than the file holds"), "";
    std::string text(length, '\0');
    if (H5Dread(set, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, text.data()) < 0) return fail(name, "cannot be read"), "";
    text.resize(text.find_last_not_of('\0') + 1);
    return text;
}

std::vector<std::string> Hdf5Reader::read_texts(const std::string& name, std::optional<std::size_t> count) {
    const std::optional<std::int64_t> opened = open_set(name);
    if (!opened) return {};
    const Handle set(*opened), space(H5Dget_space(set)), type(H5Dget_type(set));
    const std::size_t length = H5Tget_size(type);
    hsize_t extent = 0;
    if (!is_fixed_text(type) || H5Sget_simple_extent_ndims(space) != 1 ||
        H5Sget_simple_extent_dims(space, &extent, nullptr) != 1)
        return fail(name, "is not a row of texts of fixed length"), std::vector<std::string>();
    if (count && extent != *count)
        return fail(name, "has " + std::to_string(extent) + " rows in place of " + std::to_string(*count)),
               std::vector<std::string>();
    if (length > largest_text || extent >= (std::uint64_t{1} << 32) || !holds_really(set, length, extent, bytes_))
        return fail(name, "claims more texts than the file holds"), std::vector<std::string>();
    std::string padded(length * extent, '\0');
    if (extent > 0 && H5Dread(set, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, padded.data()) < 0)
        return fail(name, "cannot be read"), std::vector<std::string>();
    std::vector<std::string> texts(extent);
    for (std::size_t i = 0; i < extent; ++i) {
        texts[i] = padded.substr(i * length, length);
        texts[i].resize(texts[i].find_last_not_of('\0') + 1);
    }
    return texts;
}

namespace {

/// A scalar attribute of the class asked for, or a negative handle.
hid_t open_scalar(hid_t file, const std::string& object, const char* name, H5T_class_t kind) {
    if (H5Aexists_by_name(file, object.c_str(), name, H5P_DEFAULT) <= 0) return -1;
    const hid_t attribute = H5Aopen_by_name(file, object.c_str(), name, H5P_DEFAULT, H5P_DEFAULT);
    if (attribute < 0) return -1;
    const Handle type(H5Aget_type(attribute)), space(H5Aget_space(attribute));
    if (H5Tget_class(type) == kind && H5Sget_simple_extent_npoints(space) == 1) return attribute;
    H5Idec_ref(attribute);
    return -1;
}

}  // namespace

std::optional<std::string> Hdf5Reader::text_attribute(const std::string& object, const char* name) {
    const Handle attribute(has(object) ? open_scalar(file_, object, name, H5T_STRING) : -1);
    if (attribute < 0) return {};
    const Handle type(H5Aget_type(attribute));
    const std::size_t length = H5Tget_size(type);
    if (H5Tis_variable_str(type) != 0 || length > bytes_) return {};
    std::string text(length, '\0');
    if (H5Aread(attribute, type, text.data()) < 0) return {};
    text.resize(text.find_last_not_of('\0') + 1);
    return text;
}

std::optional<double> Hdf5Reader::number_attribute(const std::string& object, const char* name) {
    const Handle attribute(has(object) ? open_scalar(file_, object, name, H5T_FLOAT) : -1);
    double value = 0;
    if (attribute < 0 || H5Aread(attribute, H5T_NATIVE_DOUBLE, &value) < 0) return {};
    return value;
}

std::optional<std::int64_t> Hdf5Reader::integer_attribute(const std::string& object, const char* name) {
    const Handle attribute(has(object) ? open_scalar(file_, object, name, H5T_INTEGER) : -1);
    std::int64_t value = 0;
    if (attribute < 0 || H5Aread(attribute, H5T_NATIVE_INT64, &value) < 0) return {};
    return value;
}

std::vector<std::string> Hdf5Reader::attribute_names(const std::string& object) {
    std::vector<std::string> names;
    if (!has(object)) return names;
    const auto visit = [](hid_t, const char* name, const H5A_info_t*, void* out) -> herr_t {
        static_cast<std::vector<std::string>*>(out)->emplace_back(name);
        return 0;
    };
    const Handle target(H5Oopen(file_, object.c_str(), H5P_DEFAULT));
    hsize_t position = 0;
    if (target >= 0) H5Aiterate2(target, H5_INDEX_NAME, H5_ITER_INC, &position, visit, &names);
    return names;
}

}  // namespace exitance
