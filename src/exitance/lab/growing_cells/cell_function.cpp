#include "exitance/lab/growing_cells/cell_function.hpp"

#include "exitance/base/archive.hpp"

namespace exitance {
namespace {

constexpr double flatness = 0.25;      ///< s_h: reach perpendicular to the plane, relative to that along it.
constexpr double normal_spread = 0.1;  ///< s_n: 1 - cos of 26 degrees.

}  // namespace

double cell_distance(const CellLight::Cell& cell, const Point& x, const Normal& n) {
    const Vec3 w = x - cell.at;
    const double h = dot(w, cell.n);
    const double across = h / (flatness * cell.width);
    const double along = std::max(0.0, squared_norm(w) - h * h) / (cell.width * cell.width);
    return along + across * across + (1 - dot(n, cell.n)) / normal_spread;
}

double share_on_plane(const CellLight::Cell& cell, const Point& x, const Normal& n) {
    const double height = dot(n, cell.at - x);
    const Point nearest = cell.at - height * Vec3(n);
    return std::exp(height * height / (cell.width * cell.width) - cell_distance(cell, nearest, n));
}

CellFunction::CellFunction(const CellLight& light) : light_(&light) {
    std::vector<Box> boxes;
    boxes.reserve(light.cells.size());
    for (const CellLight::Cell& cell : light.cells) {
        const double reach = std::sqrt(cutoff) * cell.width;
        Box box;
        box.add(cell.at - Vec3{reach, reach, reach});
        box.add(cell.at + Vec3{reach, reach, reach});
        boxes.push_back(box);
    }
    index_ = Bvh(boxes);
}

/// The nearest cell (by |x - w|^2) among those with a similar normal, or among all if there are none. O(cells), rarely
/// called.
std::uint32_t CellFunction::nearest(const Point& x, const Normal& n) const {
    std::uint32_t best = 0;
    std::pair<bool, double> least{true, HUGE_VAL};  // whether the normal differs; squared distance
    for (std::uint32_t c = 0; c < light_->cells.size(); ++c) {
        const CellLight::Cell& cell = light_->cells[c];
        const std::pair<bool, double> own{dot(n, cell.n) <= 0.5, squared_norm(x - cell.at)};
        if (own < least) least = own, best = c;
    }
    return best;
}

/// A cell's weight; 0 beyond three widths.
double CellFunction::weight_at(const CellLight::Cell& cell, const Point& x, const Normal& n) const {
    if (light_->normalised) {
        const double q = cell_distance(cell, x, n);
        return q < cutoff ? std::exp(-q) : 0;
    }
    const double q = squared_norm(x - cell.at) / (cell.width * cell.width);
    return q < cutoff ? std::exp(-q) * share_on_plane(cell, x, n) : 0;
}

Spectrum CellFunction::at(const Point& x, const Normal& n) const {
    Spectrum sum;
    double weights = 0;
    visit(x, n, [&](std::uint32_t c, double weight) {
        const CellLight::Cell& cell = light_->cells[c];
        Spectrum value = cell.value;
        if (light_->normalised) {
            const Vec3 w = x - cell.at;
            for (std::size_t axis = 0; axis < 3; ++axis) value += w[axis] * cell.slope[axis];
        }
        sum += weight * value;
        weights += weight;
    });
    if (light_->normalised) {
        if (weights > 0) {
            sum *= 1 / weights;
        } else if (!light_->cells.empty()) {
            sum = light_->cells[nearest(x, n)].value;
        }
    }
    for (std::size_t b = 0; b < bands; ++b) sum[b] = std::max(0.0, sum[b]);
    return sum;
}

namespace {

template <class Archive>
void archive_cells(Archive& a, CellLight& light) {
    auto& [normalised, cells, triangles, kernel, kernel_edges] = light;
    a(normalised, cells, triangles, kernel, kernel_edges);
}

}  // namespace

std::string CellsForm::packed() const {
    ArchiveWriter writer;
    CellLight copy = light_;
    archive_cells(writer, copy);
    return writer.take();
}

LightFormPointer CellsForm::unpack(std::string_view bytes) {
    ArchiveReader reader(bytes);
    CellLight light;
    archive_cells(reader, light);
    return std::make_shared<CellsForm>(std::move(light));
}

const CellLight& cells_of(const Solution& solution) {
    static const CellLight none;
    const auto* form = dynamic_cast<const CellsForm*>(solution.own_form.get());
    return form ? form->light() : none;
}

}  // namespace exitance
