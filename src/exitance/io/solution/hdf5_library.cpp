#include "exitance/io/solution/hdf5_library.hpp"

#include <hdf5.h>

#include <algorithm>
#include <array>

namespace exitance {
namespace {

constexpr std::size_t max_stored_chunk_bytes = 1 << 26;  ///< Limit on the bytes of a chunk.
constexpr double max_compression = 1100;                 ///< Limit on the compression ratio; deflate's is 1032.

}  // namespace

static_assert(sizeof(hid_t) == sizeof(std::int64_t));

Hdf5Handle::~Hdf5Handle() {
    if (id_ >= 0) H5Idec_ref(id_);
}

namespace {

/// Type of 16-bit floating-point numbers (IEEE 754 binary16), little-endian, in memory and in files.
std::int64_t half_type() {
    static const hid_t type = [] {
        const hid_t half = H5Tcopy(H5T_IEEE_F32LE);
        // position of the sign; position and size of the exponent; position and size of the mantissa
        H5Tset_fields(half, 15, 10, 5, 0, 10);
        H5Tset_size(half, sizeof(Half));
        H5Tset_ebias(half, 15);
        return half;
    }();
    return type;
}

}  // namespace

std::int64_t hdf5_native_type(Hdf5Type type) {
    switch (type) {
        case Hdf5Type::float16:
            return half_type();
        case Hdf5Type::uint8:
            return H5T_NATIVE_UINT8;
        case Hdf5Type::uint16:
            return H5T_NATIVE_UINT16;
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

std::int64_t hdf5_stored_type(Hdf5Type type) {
    switch (type) {
        case Hdf5Type::float16:
            return half_type();
        case Hdf5Type::uint8:
            return H5T_STD_U8LE;
        case Hdf5Type::uint16:
            return H5T_STD_U16LE;
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

std::string hdf5_says() {
    std::string words;
    const auto visit = [](unsigned, const H5E_error2_t* error, void* out) -> herr_t {
        if (error->desc) *static_cast<std::string*>(out) = error->desc;
        return 0;
    };
    H5Ewalk2(H5E_DEFAULT, H5E_WALK_DOWNWARD, visit, &words);
    return words.empty() ? "" : " (" + words + ")";
}

void quieten_hdf5() {
    H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr);
}

bool is_fixed_text(std::int64_t type) {
    return H5Tget_class(type) == H5T_STRING && H5Tis_variable_str(type) == 0;
}

bool is_plain_number(std::int64_t type) {
    if (H5Tget_class(type) == H5T_INTEGER) return H5Tget_precision(type) == 8 * H5Tget_size(type);
    for (const hid_t known : {H5T_IEEE_F32LE, H5T_IEEE_F64LE, H5T_IEEE_F32BE, H5T_IEEE_F64BE})
        if (H5Tequal(type, known) > 0) return true;
    return H5Tequal(type, half_type()) > 0;
}

bool holds_really(std::int64_t set, std::size_t item_bytes, std::size_t items, std::uint64_t file_bytes) {
    const Hdf5Handle creation(H5Dget_create_plist(set));
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
        if (bytes > static_cast<double>(max_stored_chunk_bytes)) return false;
        if (H5Pget_nfilters(creation) > 0) grows = max_compression;
    }
    const hsize_t held = H5Dget_storage_size(set);
    if (items > hdf5_room_for(file_bytes) / std::max<std::size_t>(item_bytes, 8)) return false;
    return held <= file_bytes &&
           static_cast<double>(items) * static_cast<double>(item_bytes) <= grows * static_cast<double>(held);
}

}  // namespace exitance
