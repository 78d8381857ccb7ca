#include <hdf5.h>
#include <sys/stat.h>

#include <array>
#include <cstring>

#include "exitance/io/solution/hdf5_chunks.hpp"
#include "exitance/io/solution/hdf5_file.hpp"
#include "exitance/io/solution/hdf5_library.hpp"
#include "exitance/io/solution/hdf5_rehearsal.hpp"

namespace exitance {
namespace {

constexpr std::size_t max_text_bytes = 1 << 26;  ///< Limit on the length of a text, bytes.

}  // namespace

Result<Hdf5Reader> Hdf5Reader::open(const std::string& path, Rehearsed rehearsed) {
    quieten_hdf5();
    struct stat present;
    if (::stat(path.c_str(), &present) != 0)
        return Error{ErrorCode::cannot_read, std::string("cannot be read: ") + std::strerror(errno), path, ""};
    if (S_ISDIR(present.st_mode)) return Error{ErrorCode::cannot_read, "is a folder", path, ""};
    Hdf5Reader out;
    out.path_ = path;
    out.bytes_ = static_cast<std::uint64_t>(present.st_size);
    if (rehearsed == Rehearsed::not_yet)
        if (const auto failed = rehearse_hdf5(path, out.bytes_))
            return Error{ErrorCode::bad_input, "is damaged: the HDF5 library " + *failed + " when it reads this file",
                         path, "solve the scene again with this program"};
    const Hdf5Handle access(H5Pcreate(H5P_FILE_ACCESS));
    H5Pset_fclose_degree(access, H5F_CLOSE_STRONG);
    out.file_ = H5Fopen(path.c_str(), H5F_ACC_RDONLY, access);
    if (out.file_ < 0)
        return Error{ErrorCode::bad_input, "is not an HDF5 file, or a damaged one" + hdf5_says(), path,
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
    // Each part of the path must exist before the next one can be opened.
    for (std::size_t end = name.find('/');; end = name.find('/', end + 1)) {
        if (H5Lexists(file_, name.substr(0, end).c_str(), H5P_DEFAULT) <= 0) return false;
        if (end == std::string::npos) return true;
    }
}

std::optional<std::int64_t> Hdf5Reader::open_set(const std::string& name) {
    if (failed()) return {};
    if (!has(name)) return fail(name, "is missing"), std::nullopt;
    const hid_t set = H5Dopen2(file_, name.c_str(), H5P_DEFAULT);
    if (set < 0) return fail(name, "cannot be opened" + hdf5_says()), std::nullopt;
    return set;
}

std::optional<std::size_t> Hdf5Reader::open_numbers(const std::string& name, Hdf5Type type, std::size_t columns,
                                                    std::optional<std::size_t> rows) {
    const std::optional<std::int64_t> set = open_set(name);
    if (!set) return {};
    if (set_ >= 0) H5Idec_ref(set_);
    set_ = *set, set_name_ = name;
    const Hdf5Handle space(H5Dget_space(set_)), held(H5Dget_type(set_));
    const bool fraction = type == Hdf5Type::float16 || type == Hdf5Type::float32 || type == Hdf5Type::float64;
    if (H5Tget_class(held) != (fraction ? H5T_FLOAT : H5T_INTEGER) || !is_plain_number(held))
        return fail(name, fraction ? "does not hold fractions" : "does not hold integers"), std::nullopt;
    const int rank = H5Sget_simple_extent_ndims(space), wanted = columns == 1 ? 1 : 2;
    std::array<hsize_t, 2> extent = {0, 1};
    if (rank != wanted || H5Sget_simple_extent_dims(space, extent.data(), nullptr) != wanted || extent[1] != columns)
        return fail(name, "does not have rows of " + std::to_string(columns)), std::nullopt;
    if (rows && extent[0] != *rows)
        return fail(name, "has " + std::to_string(extent[0]) + " rows instead of " + std::to_string(*rows)),
               std::nullopt;
    if (extent[0] >= (std::uint64_t{1} << 40) || !holds_really(set_, H5Tget_size(held), extent[0] * columns, bytes_))
        return fail(name, "claims " + std::to_string(extent[0]) + " rows, more than the file holds"), std::nullopt;
    return extent[0];
}

void Hdf5Reader::read_numbers(std::span<std::byte> out, Hdf5Type type, std::size_t columns) {
    if (read_hdf5_chunks(set_, type, columns, out)) return;
    if (H5Dread(set_, hdf5_native_type(type), H5S_ALL, H5S_ALL, H5P_DEFAULT, out.data()) < 0)
        fail(set_name_, "cannot be read" + hdf5_says());
}

std::string Hdf5Reader::read_text(const std::string& name) {
    const std::optional<std::int64_t> opened = open_set(name);
    if (!opened) return {};
    const Hdf5Handle set(*opened), space(H5Dget_space(set)), type(H5Dget_type(set));
    const std::size_t length = H5Tget_size(type);
    if (!is_fixed_text(type) || H5Sget_simple_extent_npoints(space) != 1)
        return fail(name, "is not one text of fixed length"), "";
    if (length > max_text_bytes || !holds_really(set, length, 1, bytes_))
        return fail(name, "claims a text longer than the file holds"), "";
    std::string text(length, '\0');
    if (H5Dread(set, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, text.data()) < 0) return fail(name, "cannot be read"), "";
    text.resize(text.find_last_not_of('\0') + 1);
    return text;
}

std::vector<std::string> Hdf5Reader::read_texts(const std::string& name, std::optional<std::size_t> count) {
    const std::optional<std::int64_t> opened = open_set(name);
    if (!opened) return {};
    const Hdf5Handle set(*opened), space(H5Dget_space(set)), type(H5Dget_type(set));
    const std::size_t length = H5Tget_size(type);
    hsize_t extent = 0;
    if (!is_fixed_text(type) || H5Sget_simple_extent_ndims(space) != 1 ||
        H5Sget_simple_extent_dims(space, &extent, nullptr) != 1)
        return fail(name, "is not a row of texts of fixed length"), std::vector<std::string>();
    if (count && extent != *count)
        return fail(name, "has " + std::to_string(extent) + " rows instead of " + std::to_string(*count)),
               std::vector<std::string>();
    if (length > max_text_bytes || extent >= (std::uint64_t{1} << 32) || !holds_really(set, length, extent, bytes_))
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

/// Opens a scalar attribute of type class `kind`; returns a negative handle if there is none.
hid_t open_scalar(hid_t file, const std::string& object, const char* name, H5T_class_t kind) {
    if (H5Aexists_by_name(file, object.c_str(), name, H5P_DEFAULT) <= 0) return -1;
    const hid_t attribute = H5Aopen_by_name(file, object.c_str(), name, H5P_DEFAULT, H5P_DEFAULT);
    if (attribute < 0) return -1;
    const Hdf5Handle type(H5Aget_type(attribute)), space(H5Aget_space(attribute));
    if (H5Tget_class(type) == kind && H5Sget_simple_extent_npoints(space) == 1) return attribute;
    H5Idec_ref(attribute);
    return -1;
}

}  // namespace

std::optional<std::string> Hdf5Reader::text_attribute(const std::string& object, const char* name) {
    const Hdf5Handle attribute(has(object) ? open_scalar(file_, object, name, H5T_STRING) : -1);
    if (attribute < 0) return {};
    const Hdf5Handle type(H5Aget_type(attribute));
    const std::size_t length = H5Tget_size(type);
    if (H5Tis_variable_str(type) != 0 || length > bytes_) return {};
    std::string text(length, '\0');
    if (H5Aread(attribute, type, text.data()) < 0) return {};
    text.resize(text.find_last_not_of('\0') + 1);
    return text;
}

std::optional<double> Hdf5Reader::number_attribute(const std::string& object, const char* name) {
    const Hdf5Handle attribute(has(object) ? open_scalar(file_, object, name, H5T_FLOAT) : -1);
    double value = 0;
    if (attribute < 0 || H5Aread(attribute, H5T_NATIVE_DOUBLE, &value) < 0) return {};
    return value;
}

std::optional<std::int64_t> Hdf5Reader::integer_attribute(const std::string& object, const char* name) {
    const Hdf5Handle attribute(has(object) ? open_scalar(file_, object, name, H5T_INTEGER) : -1);
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
    const Hdf5Handle target(H5Oopen(file_, object.c_str(), H5P_DEFAULT));
    hsize_t position = 0;
    if (target >= 0) H5Aiterate2(target, H5_INDEX_NAME, H5_ITER_INC, &position, visit, &names);
    return names;
}

}  // namespace exitance
