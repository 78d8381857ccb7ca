#include "exitance/io/solution/hdf5_rehearsal.hpp"

#include <hdf5.h>

#include <new>
#include <set>
#include <vector>

#include "exitance/io/files/rehearsal.hpp"
#include "exitance/io/solution/hdf5_library.hpp"

namespace exitance {
namespace {

/// Reads every data set and attribute of a solution into one reused buffer.
class Rehearsal {
  public:
    explicit Rehearsal(std::uint64_t file_bytes) : file_bytes_(file_bytes) {}

    /// True if all objects could be opened. An object that failed must not be opened again: the library may accept its
    /// incomplete state.
    bool read(hid_t file) { return H5Lexists(file, "exitance", H5P_DEFAULT) <= 0 || object(file, "exitance"); }

  private:
    /// Number of items if they are of a supported type, otherwise 0.
    static std::size_t items_of(hid_t type, hid_t space) {
        const hssize_t count = H5Sget_simple_extent_npoints(space);
        const bool known = H5Tget_size(type) > 0 && (is_fixed_text(type) || is_plain_number(type));
        return count > 0 && known ? static_cast<std::size_t>(count) : 0;
    }

    char* room(std::size_t bytes) {
        if (buffer_.size() < bytes) {
            buffer_ = {};  // freed before the larger one is allocated
            buffer_.resize(bytes);
        }
        return buffer_.data();
    }

    bool attribute(hid_t object, const char* name) {
        const Hdf5Handle attribute(H5Aopen(object, name, H5P_DEFAULT));
        if (attribute < 0) return false;
        const Hdf5Handle type(H5Aget_type(attribute)), space(H5Aget_space(attribute));
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
        const Hdf5Handle type(H5Dget_type(set)), space(H5Dget_space(set));
        if (type < 0 || space < 0) return false;
        const std::size_t items = items_of(type, space), size = H5Tget_size(type);
        if (items > 0 && holds_really(set, size, items, file_bytes_))
            H5Dread(set, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, room(items * size));
        return true;
    }

    /// Reads an object and everything below it.
    bool object(hid_t from, const char* name) {
        const Hdf5Handle object(H5Oopen(from, name, H5P_DEFAULT));
        H5O_info_t info;
        if (object < 0 || H5Oget_info2(object, &info, H5O_INFO_BASIC) < 0) return false;
        if (!seen_.insert(info.addr).second) return true;
        if (!attributes(object)) return false;
        if (info.type == H5O_TYPE_GROUP) return members(object);
        return info.type != H5O_TYPE_DATASET || numbers(object);
    }

    std::uint64_t file_bytes_;
    std::vector<char> buffer_;
    std::set<haddr_t> seen_;  ///< Addresses of visited objects, since links may form cycles.
};

/// Detects whether the library ran out of memory, which it only reports in the error messages of a failing call.
class MemoryWatch {
  public:
    MemoryWatch() { H5Eset_auto2(H5E_DEFAULT, look, &lacking_); }
    ~MemoryWatch() { quieten_hdf5(); }
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

}  // namespace

bool read_all_of_hdf5(const std::string& path, std::uint64_t file_bytes) {
    quieten_hdf5();
    const MemoryWatch memory;
    const Hdf5Handle access(H5Pcreate(H5P_FILE_ACCESS));
    H5Pset_fclose_degree(access, H5F_CLOSE_STRONG);
    const hid_t file = H5Fopen(path.c_str(), H5F_ACC_RDONLY, access);
    const bool whole = file < 0 || Rehearsal(file_bytes).read(file);
    if (memory.lacking()) throw std::bad_alloc();
    if (file >= 0) H5Fclose(file);
    return whole;
}

std::optional<std::string> rehearse_hdf5(const std::string& path, std::uint64_t file_bytes) {
    return rehearse([&] { return read_all_of_hdf5(path, file_bytes); }, 2 + 1e-7 * static_cast<double>(file_bytes),
                    hdf5_room_for(file_bytes));
}

}  // namespace exitance
