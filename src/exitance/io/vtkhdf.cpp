#include "exitance/io/element_mesh.hpp"
#include "exitance/io/solution_groups.hpp"

namespace exitance {

void write_vtkhdf(Hdf5Writer& file, const Solution& solution) {
    const ElementMesh mesh = make_element_mesh(solution);
    std::vector<std::int64_t> connectivity(mesh.point_count()), offsets = {0};
    for (std::size_t i = 0; i < connectivity.size(); ++i) connectivity[i] = static_cast<std::int64_t>(i);
    std::vector<std::uint8_t> types;
    for (ElementId e : mesh.leaves) {
        const bool triangle = solution.interpolant.tree.patch(e).is_triangle();
        types.push_back(triangle ? vtk_triangle : vtk_quad);
        offsets.push_back(offsets.back() + (triangle ? 3 : 4));
    }

    file.make_group("VTKHDF");
    const std::int64_t version[2] = {1, 0}, counts[2] = {static_cast<std::int64_t>(mesh.point_count()),
                                                         static_cast<std::int64_t>(mesh.leaves.size())};
    file.set_attribute("VTKHDF", "Version", std::span<const std::int64_t>(version));
    file.set_attribute("VTKHDF", "Type", std::string_view("UnstructuredGrid"));
    file.write("VTKHDF/NumberOfPoints", std::span(counts, 1), 1, {"1", "points"});
    file.write("VTKHDF/NumberOfCells", std::span(counts + 1, 1), 1, {"1", "cells: leaf elements"});
    file.write("VTKHDF/NumberOfConnectivityIds", std::span(counts, 1), 1, {"1", "corners of all cells"});
    file.write("VTKHDF/Points", mesh.points, 3, {"m", "corners of the elements, each element with its own"});
    file.write("VTKHDF/Connectivity", connectivity, 1, {"1", "points of the cells"});
    file.write("VTKHDF/Offsets", offsets, 1, {"1", "where the points of a cell begin in Connectivity"});
    file.write("VTKHDF/Types", types, 1, {"1", "VTK's cell types: 5 triangle, 9 quadrilateral"});
    file.make_group("VTKHDF/PointData");
    file.write("VTKHDF/PointData/radiosity", mesh.radiosity, bands, {"W/m^2", "flux leaving the front per area"});
    file.write("VTKHDF/PointData/irradiance", mesh.irradiance, bands, {"W/m^2", "flux arriving on the front per area"});
    file.make_group("VTKHDF/CellData");
    for (const auto& [name, ids] : mesh.cell_ids())
        file.write(std::string("VTKHDF/CellData/") + name, *ids, 1, {"1", "row in /exitance/scene"});
}

}  // namespace exitance
