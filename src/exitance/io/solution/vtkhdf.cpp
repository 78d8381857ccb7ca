#include "exitance/io/export/element_mesh.hpp"
#include "exitance/io/solution/solution_groups.hpp"

namespace exitance {

void write_vtkhdf(Hdf5Writer& file, const Solution& solution) {
    const ElementMesh mesh = make_cells(solution);
    const auto point_count = static_cast<std::int64_t>(mesh.points.size());
    const auto cell_count = static_cast<std::int64_t>(mesh.size());
    const std::vector<std::int64_t> connectivity = mesh.cell_points();
    const std::vector<std::int64_t> offsets(mesh.first_point.begin(), mesh.first_point.end());
    const auto corner_count = static_cast<std::int64_t>(connectivity.size());
    const std::vector<std::uint8_t> types = mesh.cell_types();

    file.make_group("VTKHDF");
    const std::int64_t version[2] = {1, 0};
    file.set_attribute("VTKHDF", "Version", std::span<const std::int64_t>(version));
    file.set_attribute("VTKHDF", "Type", std::string_view("UnstructuredGrid"));
    file.write("VTKHDF/NumberOfPoints", std::span(&point_count, 1), 1, {"1", "points"});
    file.write("VTKHDF/NumberOfCells", std::span(&cell_count, 1), 1, {"1", "cells: leaf elements"});
    file.write("VTKHDF/NumberOfConnectivityIds", std::span(&corner_count, 1), 1, {"1", "corners of all cells"});
    file.write("VTKHDF/Points", flat(mesh.points), 3,
               {"m", "corners of the elements, each element with its own, or nodes of quadratic or cubic triangles"});
    file.write("VTKHDF/Connectivity", connectivity, 1, {"1", "points of the cells"});
    file.write("VTKHDF/Offsets", offsets, 1, {"1", "where the points of a cell begin in Connectivity"});
    file.write(
        "VTKHDF/Types", types, 1,
        {"1", "VTK's cell types: 5 triangle, 7 polygon, 9 quadrilateral, 22 quadratic triangle, 69 Lagrange triangle"});
    file.make_group("VTKHDF/PointData");
    file.write("VTKHDF/PointData/radiosity", flat(mesh.radiosity), bands, {"W/m^2", "flux leaving the front per area"});
    file.write("VTKHDF/PointData/irradiance", flat(mesh.irradiance), bands,
               {"W/m^2", "flux arriving on the front per area"});
    file.make_group("VTKHDF/CellData");
    for (const auto& [name, ids] : mesh.cell_ids())
        file.write(std::string("VTKHDF/CellData/") + name, *ids, 1, {"1", "row in /exitance/scene"});
}

}  // namespace exitance
