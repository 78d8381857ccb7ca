#include "exitance/io/solution/hdf5_output.hpp"

#include <hdf5.h>
#if __has_include(<H5FDdevelop.h>)
#include <H5FDdevelop.h>
#endif

#include <algorithm>

namespace exitance {
namespace {

/// An open file of this driver. The library requires its own data to be first.
struct Open {
    H5FD_t common;
    AtomicFile* output;
    haddr_t claimed, written;  ///< End of the library's allocated space, and of the bytes written.
};

H5FD_t* open_file(const char*, unsigned, hid_t access, haddr_t) {
    AtomicFile* const* const output = static_cast<AtomicFile* const*>(H5Pget_driver_info(access));
    return output ? &(new Open{{}, *output, 0, 0})->common : nullptr;
}

Open& of(H5FD_t* file) {
    return *reinterpret_cast<Open*>(file);
}
const Open& of(const H5FD_t* file) {
    return *reinterpret_cast<const Open*>(file);
}

herr_t close_file(H5FD_t* file) {
    delete &of(file);
    return 0;
}

/// Enables buffering of small pieces, as the library's own drivers do.
herr_t query(const H5FD_t*, unsigned long* flags) {
    *flags = H5FD_FEAT_AGGREGATE_METADATA | H5FD_FEAT_ACCUMULATE_METADATA | H5FD_FEAT_DATA_SIEVE |
             H5FD_FEAT_AGGREGATE_SMALLDATA;
    return 0;
}

haddr_t end_of_claimed(const H5FD_t* file, H5FD_mem_t) {
    return of(file).claimed;
}
herr_t claim(H5FD_t* file, H5FD_mem_t, haddr_t end) {
    of(file).claimed = end;
    return 0;
}
haddr_t end_of_written(const H5FD_t* file, H5FD_mem_t) {
    return of(file).written;
}

herr_t read(H5FD_t* file, H5FD_mem_t, hid_t, haddr_t place, std::size_t size, void* out) {
    of(file).output->read_at(place, {static_cast<std::byte*>(out), size});
    return 0;
}
herr_t write(H5FD_t* file, H5FD_mem_t, hid_t, haddr_t place, std::size_t size, const void* data) {
    Open& f = of(file);
    f.output->write_at(place, {static_cast<const std::byte*>(data), size});
    f.written = std::max(f.written, static_cast<haddr_t>(place + size));
    return 0;
}

/// Extends the file to the allocated size.
herr_t truncate(H5FD_t* file, hid_t, hbool_t) {
    Open& f = of(file);
    if (f.written >= f.claimed) return 0;
    const std::byte last{0};
    f.output->write_at(f.claimed - 1, {&last, 1});
    f.written = f.claimed;
    return 0;
}

H5FD_class_t make_driver() {
    H5FD_class_t d{};
#ifdef H5FD_CLASS_VERSION
    d.version = H5FD_CLASS_VERSION;
    d.value = static_cast<H5FD_class_value_t>(512);  // one of the values reserved for testing
#endif
    d.name = "exitance";
    d.maxaddr = (haddr_t(1) << 62) - 1;
    d.fc_degree = H5F_CLOSE_STRONG;
    d.fapl_size = sizeof(AtomicFile*);
    d.open = open_file, d.close = close_file, d.query = query;
    d.get_eoa = end_of_claimed, d.set_eoa = claim, d.get_eof = end_of_written;
    d.read = read, d.write = write, d.truncate = truncate;
    const H5FD_mem_t kinds[H5FD_MEM_NTYPES] = H5FD_FLMAP_DICHOTOMY;
    std::copy(std::begin(kinds), std::end(kinds), std::begin(d.fl_map));
    return d;
}

}  // namespace

void set_hdf5_output(std::int64_t file_access, AtomicFile& output) {
    static const H5FD_class_t driver = make_driver();
    static const hid_t registered = H5FDregister(&driver);
    AtomicFile* const held = &output;
    H5Pset_driver(file_access, registered, &held);
}

}  // namespace exitance
