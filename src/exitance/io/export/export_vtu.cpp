#include <bit>

#include "exitance/io/export/element_mesh.hpp"
#include "exitance/io/export/export_formats.hpp"
#include "exitance/io/files/atomic_file.hpp"
#include "exitance/scene/photometric_units.hpp"

namespace exitance {
namespace {

/// Encodes bytes as Base64 in pieces.
class Base64 {
  public:
    explicit Base64(AtomicFile& file) : file_(file) {}

    void add(std::span<const std::byte> bytes) {
        std::string out;
        out.reserve(bytes.size() / 3 * 4 + 8);
        for (const std::byte b : bytes) {
            held_ = held_ << 8 | std::to_integer<std::uint32_t>(b);
            if (++count_ == 3) put(out, 4);
        }
        file_.write(out);
    }
    void finish() {
        if (count_ == 0) return;
        const int sextets = count_ + 1;
        held_ <<= 8 * (3 - count_);
        std::string out;
        put(out, sextets);
        file_.write(out.append(static_cast<std::size_t>(4 - sextets), '='));
    }

  private:
    void put(std::string& out, int sextets) {
        static constexpr char digit[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
        for (int i = 0; i < sextets; ++i) out += digit[held_ >> (18 - 6 * i) & 63];
        held_ = 0, count_ = 0;
    }

    AtomicFile& file_;
    std::uint32_t held_ = 0;
    int count_ = 0;
};

template <class T>
constexpr const char* vtk_type() {
    if constexpr (std::is_same_v<T, float>) return "Float32";
    if constexpr (std::is_same_v<T, double>) return "Float64";
    if constexpr (std::is_same_v<T, std::int32_t>) return "Int32";
    if constexpr (std::is_same_v<T, std::int64_t>) return "Int64";
    if constexpr (std::is_same_v<T, std::uint8_t>) return "UInt8";
}

template <class T>
void write_array(AtomicFile& file, const char* name, std::span<const T> values, std::size_t columns) {
    file.write(std::string("<DataArray type=\"") + vtk_type<T>() + "\" Name=\"" + name + "\" NumberOfComponents=\"" +
               std::to_string(columns) + "\" format=\"binary\">");
    Base64 base64(file);
    const std::uint64_t bytes = values.size_bytes();
    base64.add(std::as_bytes(std::span(&bytes, 1)));
    base64.add(std::as_bytes(values));
    base64.finish();
    file.write("</DataArray>\n");
}

}  // namespace

Result<void> write_vtu(const Solution& solution, const std::string& path) {
    static_assert(std::endian::native == std::endian::little);
    const ElementMesh mesh = make_cells(solution);
    const std::vector<std::int64_t> connectivity = mesh.cell_points();
    const std::vector<std::int64_t> ends(mesh.first_point.begin() + 1, mesh.first_point.end());
    const std::vector<std::uint8_t> types = mesh.cell_types();

    Result<AtomicFile> file = AtomicFile::create(path);
    if (!file) return file.error();
    file->write(std::string("<?xml version=\"1.0\"?>\n<!-- exitance: points in metres, radiosity and irradiance in ") +
                own_unit(solution.scene.is_photometric()).radiosity() +
                " -->\n<VTKFile "
                "type=\"UnstructuredGrid\" version=\"1.0\" "
                "byte_order=\"LittleEndian\" header_type=\"UInt64\">\n<UnstructuredGrid>\n<Piece NumberOfPoints=\"" +
                std::to_string(mesh.points.size()) + "\" NumberOfCells=\"" + std::to_string(mesh.size()) + "\">\n");
    file->write("<PointData Vectors=\"radiosity\">\n");
    write_array(*file, "radiosity", numbers_of(mesh.radiosity), bands);
    write_array(*file, "irradiance", numbers_of(mesh.irradiance), bands);
    file->write("</PointData>\n<CellData>\n");
    for (const auto& [name, ids] : mesh.cell_ids()) write_array(*file, name, std::span<const std::int32_t>(*ids), 1);
    file->write("</CellData>\n<Points>\n");
    write_array(*file, "Points", numbers_of(mesh.points), 3);
    file->write("</Points>\n<Cells>\n");
    write_array(*file, "connectivity", std::span<const std::int64_t>(connectivity), 1);
    write_array(*file, "offsets", std::span<const std::int64_t>(ends), 1);
    write_array(*file, "types", std::span<const std::uint8_t>(types), 1);
    file->write("</Cells>\n</Piece>\n</UnstructuredGrid>\n</VTKFile>\n");
    return file->commit();
}

}  // namespace exitance
