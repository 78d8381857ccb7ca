#include <string>

#include "exitance/io/export/element_mesh.hpp"
#include "exitance/io/solution/solution_groups.hpp"

namespace exitance {
namespace {

constexpr Hdf5Label of_points{"m",
                              "corners of the elements, each element with its own, or nodes of quadratic or cubic "
                              "triangles"},
    of_connectivity{"1", "points of the cells"}, of_offsets{"1", "where the points of a cell begin in Connectivity"},
    of_types{"1",
             "VTK's cell types: 5 triangle, 7 polygon, 9 quadrilateral, 22 quadratic triangle, 69 Lagrange triangle"},
    of_radiosity{"W/m^2", "flux leaving the front per area"},
    of_irradiance{"W/m^2", "flux arriving on the front per area"}, of_ids{"1", "row in /exitance/scene"};

std::string in_cells(const char* name) {
    return std::string("VTKHDF/CellData/") + name;
}

void write_counts(Hdf5Writer& file, std::int64_t points, std::int64_t cells, std::int64_t corners) {
    file.make_group("VTKHDF");
    const std::int64_t version[2] = {1, 0};
    file.set_attribute("VTKHDF", "Version", std::span<const std::int64_t>(version));
    file.set_attribute("VTKHDF", "Type", std::string_view("UnstructuredGrid"));
    file.write("VTKHDF/NumberOfPoints", std::span<const std::int64_t>(&points, 1), 1, {"1", "points"});
    file.write("VTKHDF/NumberOfCells", std::span<const std::int64_t>(&cells, 1), 1, {"1", "cells: leaf elements"});
    file.write("VTKHDF/NumberOfConnectivityIds", std::span<const std::int64_t>(&corners, 1), 1,
               {"1", "corners of all cells"});
}

void write_mesh(Hdf5Writer& file, const ElementMesh& mesh) {
    const std::vector<std::int64_t> connectivity = mesh.cell_points();
    const std::vector<std::int64_t> offsets(mesh.first_point.begin(), mesh.first_point.end());
    write_counts(file, static_cast<std::int64_t>(mesh.points.size()), static_cast<std::int64_t>(mesh.size()),
                 static_cast<std::int64_t>(connectivity.size()));
    file.write("VTKHDF/Points", numbers_of(mesh.points), 3, of_points);
    file.write("VTKHDF/Connectivity", connectivity, 1, of_connectivity);
    file.write("VTKHDF/Offsets", offsets, 1, of_offsets);
    file.write("VTKHDF/Types", mesh.cell_types(), 1, of_types);
    file.make_group("VTKHDF/PointData");
    file.write("VTKHDF/PointData/radiosity", numbers_of(mesh.radiosity), bands, of_radiosity);
    file.write("VTKHDF/PointData/irradiance", numbers_of(mesh.irradiance), bands, of_irradiance);
    file.make_group("VTKHDF/CellData");
    for (const auto& [name, ids] : mesh.cell_ids()) file.write(in_cells(name), *ids, 1, of_ids);
}

/// Writes the leaves of the interpolant as cells. Rows are computed while they are written, since there may be many.
class LeafWriter {
  public:
    LeafWriter(Hdf5Writer& file, const Solution& solution) : file_(file), solution_(solution) {
        for (ElementId e : tree_.ids())
            if (tree_.is_leaf(e)) ++leaves_, corners_ += tree_.domain(e).size();
    }

    void write() {
        const auto corners = static_cast<std::int64_t>(corners_);
        write_counts(file_, corners, static_cast<std::int64_t>(leaves_), corners);
        CornerWalk walk(tree_);
        file_.write_rows<double>("VTKHDF/Points", corners_, 3, of_points, [&](std::size_t, std::span<double> row) {
            walk.next();
            const Point p = tree_.patch(walk.leaf()).at(walk.uv());
            row[0] = p.x, row[1] = p.y, row[2] = p.z;
        });
        file_.write_rows<std::int64_t>("VTKHDF/Connectivity", corners_, 1, of_connectivity,
                                       [](std::size_t i, auto row) { row[0] = static_cast<std::int64_t>(i); });
        write_shapes();
        file_.make_group("VTKHDF/PointData");
        write_light("radiosity", of_radiosity, [](const Material& m, double irradiance, std::size_t b) {
            return m.exitance[b] + m.reflectance[b] * irradiance;
        });
        write_light("irradiance", of_irradiance,
                    [](const Material&, double irradiance, std::size_t) { return irradiance; });
        write_ids();
    }

  private:
    /// Iterates over the leaves.
    class LeafWalk {
      public:
        explicit LeafWalk(const ElementTree& tree) : tree_(tree) {}
        ElementId next() {
            while (!tree_.is_leaf(ElementId(at_))) ++at_;
            return ElementId(at_++);
        }

      private:
        const ElementTree& tree_;
        std::size_t at_ = 0;
    };

    void write_shapes() {
        LeafWalk of_offset(tree_), of_type(tree_);
        std::int64_t first = 0;
        file_.write_rows<std::int64_t>("VTKHDF/Offsets", leaves_ + 1, 1, of_offsets, [&](std::size_t i, auto row) {
            row[0] = first;
            if (i < leaves_) first += static_cast<std::int64_t>(tree_.domain(of_offset.next()).size());
        });
        file_.write_rows<std::uint8_t>("VTKHDF/Types", leaves_, 1, of_types, [&](std::size_t, auto row) {
            row[0] = vtk_cell_type(tree_.domain(of_type.next()).size());
        });
    }

    template <class Value>
    void write_light(const char* name, Hdf5Label label, const Value& value) {
        CornerWalk walk(tree_);
        file_.write_rows<float>(std::string("VTKHDF/PointData/") + name, corners_, bands, label,
                                [&](std::size_t, std::span<float> row) {
                                    walk.next();
                                    const Spectrum irradiance = solution_.interpolant.at({walk.leaf(), walk.uv()});
                                    const Material& material = solution_.scene.material(tree_.region(walk.leaf()));
                                    for (std::size_t b = 0; b < bands; ++b)
                                        row[b] = static_cast<float>(value(material, irradiance[b], b));
                                });
    }

    void write_ids() {
        file_.make_group("VTKHDF/CellData");
        const std::vector<std::int32_t> faces = faces_of_leaves(solution_);
        const Scene& scene = solution_.scene;
        file_.write(in_cells("surface"), faces, 1, of_ids);
        LeafWalk of_region(tree_), of_material(tree_);
        file_.write_rows<std::int32_t>(in_cells("region"), leaves_, 1, of_ids, [&](std::size_t, auto row) {
            row[0] = static_cast<std::int32_t>(tree_.region(of_region.next()).value);
        });
        file_.write_rows<std::int32_t>(in_cells("material"), leaves_, 1, of_ids, [&](std::size_t, auto row) {
            row[0] = static_cast<std::int32_t>(scene.regions()[tree_.region(of_material.next())].material.value);
        });
        file_.write_rows<std::int32_t>(in_cells("group"), leaves_, 1, of_ids, [&](std::size_t i, auto row) {
            const auto face = static_cast<std::size_t>(faces[i]);
            row[0] = static_cast<std::int32_t>(scene.surfaces()[SurfaceId(face)].group.value);
        });
    }

    Hdf5Writer& file_;
    const Solution& solution_;
    const ElementTree& tree_ = solution_.interpolant.tree;
    std::size_t leaves_ = 0, corners_ = 0;
};

}  // namespace

void write_vtkhdf(Hdf5Writer& file, const Solution& solution) {
    if (solution.discontinuity.empty())
        LeafWriter(file, solution).write();
    else
        write_mesh(file, make_cells(solution));
}

}  // namespace exitance
