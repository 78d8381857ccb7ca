#include "exitance/measure/light_maps/mesh_texels.hpp"

#include <algorithm>
#include <cmath>

#include "exitance/base/parallel.hpp"
#include "exitance/base/quadrature.hpp"
#include "exitance/measure/light_maps/texel_cover.hpp"
#include "exitance/measure/pictures/tile_light.hpp"
#include "exitance/transport/open_points.hpp"

namespace exitance {
namespace {

using Triangle2 = std::array<Vec2, 3>;

/// A triangle's polynomial as a function of texel positions in a chart.
class PlacedPolynomial {
  public:
    explicit PlacedPolynomial(const Triangle2& corner)
        : origin_(corner[0]), a_(corner[1] - corner[0]), b_(corner[2] - corner[0]), area_(cross(a_, b_)) {}

    void read(const SixNodeMesh& mesh, std::uint32_t triangle) {
        if (mesh.is_clough_tocher())
            for (std::size_t b = 0; b < bands; ++b) elements_.push_back(mesh.element(triangle, b));
        else
            for (std::size_t i = 0; i < 6; ++i) values_[i] = mesh.value(mesh.nodes[triangle][i]);
    }
    void read(const QuadraticTriangle& triangle) { values_ = triangle.values; }

    Spectrum at(Vec2 place) const {
        const Vec2 w = place - origin_;
        // Clamped to the triangle, since rounding errors are large in slivers.
        const Vec2 st{std::clamp(cross(w, b_) / area_, 0.0, 1.0), std::clamp(cross(a_, w) / area_, 0.0, 1.0)};
        Spectrum out;
        if (elements_.empty()) {
            const std::array<double, 6> weight = six_node_weights(st);
            for (std::size_t i = 0; i < 6; ++i) out += weight[i] * values_[i];
        } else {
            for (std::size_t b = 0; b < bands; ++b) out[b] = elements_[b].at({1 - st.x - st.y, st.x, st.y});
        }
        return out;
    }
    bool is_cubic() const { return !elements_.empty(); }

  private:
    Vec2 origin_, a_, b_;
    double area_;
    std::array<Spectrum, 6> values_;
    std::vector<CloughTocher> elements_;  ///< One Clough-Tocher element per band; empty: the triangle is quadratic.
};

bool holds_texel(const Triangle2& t, int x, int y) {
    for (std::size_t i = 0; i < 3; ++i) {
        const Vec2 a = t[i], edge = t[(i + 1) % 3] - a;
        for (int k = 0; k < 4; ++k)
            if (cross(edge, Vec2{x + double(k & 1), y + double(k >> 1)} - a) < 0) return false;
    }
    return true;
}

/// Calls visit(x, y) for all texels of a rectangle that a triangle's bounding box touches.
template <class Visit>
void visit_texels(const Triangle2& t, const Chart::Rectangle& r, const Visit& visit) {
    const auto [x_lo, x_hi] = std::minmax({t[0].x, t[1].x, t[2].x});
    const auto [y_lo, y_hi] = std::minmax({t[0].y, t[1].y, t[2].y});
    const int x1 = std::min(r.x + r.width, static_cast<int>(std::ceil(x_hi)));
    const int y1 = std::min(r.y + r.height, static_cast<int>(std::ceil(y_hi)));
    for (int y = std::max(r.y, static_cast<int>(std::floor(y_lo))); y < y1; ++y)
        for (int x = std::max(r.x, static_cast<int>(std::floor(x_lo))); x < x1; ++x) visit(x, y);
}

/// Adds integrals of polynomials over triangles to the texels.
class PartIntegrator {
  public:
    PartIntegrator(const Chart::Rectangle& rectangle, std::vector<MeshTexels::Integral>& out)
        : rectangle_(rectangle), out_(out) {}

    /// Adds a triangle, counter-clockwise in texel positions, on which `light` is one polynomial. Null `light`: adds
    /// only its area. `area`: the area to increase; null: none.
    void add(const Triangle2& piece, const PlacedPolynomial* light, double MeshTexels::Integral::*area) {
        visit_texels(piece, rectangle_, [&](int x, int y) {
            MeshTexels::Integral& sum =
                out_[static_cast<std::size_t>((y - rectangle_.y) * rectangle_.width + x - rectangle_.x)];
            if (holds_texel(piece, x, y)) {
                if (area) sum.*area += 1;
                if (!light) return;
                for (const PlanarNode& node : square_rule(2))
                    sum.light += node.weight * light->at({x + node.at.x, y + node.at.y});
                return;
            }
            polygon_.assign(piece.begin(), piece.end());
            clip_to_texel(polygon_, x, y, rest_);
            for (std::size_t i = 2; i < polygon_.size(); ++i)
                add_triangle({polygon_[0], polygon_[i - 1], polygon_[i]}, light, area, sum);
        });
    }

  private:
    static void add_triangle(const Triangle2& t, const PlacedPolynomial* light, double MeshTexels::Integral::*area,
                             MeshTexels::Integral& sum) {
        const Vec2 a = t[1] - t[0], b = t[2] - t[0];
        const double size = 0.5 * cross(a, b);
        if (!(size > 0)) return;
        if (area) sum.*area += size;
        if (!light) return;
        for (const PlanarNode& node : triangle_rule(light->is_cubic() ? 3 : 2))
            sum.light += size * node.weight * light->at(t[0] + node.at.x * a + node.at.y * b);
    }

    Chart::Rectangle rectangle_;
    std::vector<MeshTexels::Integral>& out_;
    std::vector<Vec2> polygon_, rest_;
};

int tiles_across(const Chart& chart) {
    return (chart.width + tile_side - 1) / tile_side;
}
int tiles_down(const Chart& chart) {
    return (chart.height + tile_side - 1) / tile_side;
}

}  // namespace

std::optional<Spectrum> MeshTexels::Integral::mean(double share) const {
    // Share of a texel. Derived from the gaps at borders by single-precision coordinates of layers, which are smaller.
    constexpr double min_share = 1e-3;
    if (open + buried < (1 - min_share) * share - min_share * min_share || open < min_share * share)
        return std::nullopt;
    return light / open;
}

MeshTexels::MeshTexels(const MeshLight& light, const Stage& stage, std::span<const Chart> charts)
    : light_(light), charts_(charts) {
    if (light.empty()) return;
    std::vector<std::uint32_t> chart_of(stage.scene.regions().size());
    for (std::size_t c = 0; c < charts.size(); ++c) chart_of[charts[c].region.value] = static_cast<std::uint32_t>(c);
    add_mesh_parts(stage, chart_of);
    add_layer_parts(chart_of);
    // Makes corners counter-clockwise: a chart may show its plane mirrored.
    for (Part& part : parts_)
        if (cross(part.corner[1] - part.corner[0], part.corner[2] - part.corner[0]) < 0)
            std::swap(part.corner[1], part.corner[2]), part.is_mirrored = true;
    sort_into_tiles();
}

void MeshTexels::add_mesh_parts(const Stage& stage, std::span<const std::uint32_t> chart_of) {
    const SixNodeMesh& mesh = light_.mesh();
    parts_.resize(mesh.size()), chart_of_part_.resize(mesh.size());
    parallel_for(mesh.size(), 256, [&](std::size_t t) {
        const RegionId region = mesh.region[t];
        chart_of_part_[t] = chart_of[region.value];
        Part& part = parts_[t];
        part.triangle = static_cast<std::uint32_t>(t);
        for (std::size_t k = 0; k < 3; ++k)
            part.corner[k] = charts_[chart_of_part_[t]].place(mesh.points[mesh.nodes[t][k]]);
        part.is_open = is_in_open(stage, mesh.centre(part.triangle), stage.scene.regions()[region].plane.n, region);
    });
}

void MeshTexels::add_layer_parts(std::span<const std::uint32_t> chart_of) {
    for (std::size_t t = 0; t < light_.layer_triangle_count(); ++t) {
        const QuadraticTriangle triangle = light_.layer_triangle(t);
        const std::uint32_t chart = chart_of[triangle.region.value];
        Part part{{}, static_cast<std::uint32_t>(t), true};
        for (std::size_t k = 0; k < 3; ++k) part.corner[k] = charts_[chart].place(triangle.corners[k]);
        parts_.push_back(part), chart_of_part_.push_back(chart);
    }
}

template <class Visit>
void MeshTexels::visit_tiles(std::size_t p, const Visit& visit) const {
    const Chart& chart = charts_[chart_of_part_[p]];
    Triangle2 scaled = parts_[p].corner;
    for (Vec2& corner : scaled) corner = (1.0 / tile_side) * corner;
    const std::size_t first = first_tile_[chart_of_part_[p]];
    visit_texels(scaled, {0, 0, tiles_across(chart), tiles_down(chart)},
                 [&](int x, int y) { visit(first + static_cast<std::size_t>(y * tiles_across(chart) + x)); });
}

void MeshTexels::sort_into_tiles() {
    std::size_t tiles = 0;
    for (const Chart& chart : charts_) {
        first_tile_.push_back(tiles);
        tiles += static_cast<std::size_t>(tiles_across(chart)) * static_cast<std::size_t>(tiles_down(chart));
    }
    begin_.assign(tiles + 1, 0);
    for (std::size_t p = 0; p < parts_.size(); ++p) visit_tiles(p, [&](std::size_t tile) { ++begin_[tile + 1]; });
    for (std::size_t tile = 0; tile < tiles; ++tile) begin_[tile + 1] += begin_[tile];
    in_tile_.resize(begin_.back());
    std::vector<std::size_t> next(begin_.begin(), begin_.end() - 1);
    for (std::size_t p = 0; p < parts_.size(); ++p)
        visit_tiles(p, [&](std::size_t tile) { in_tile_[next[tile]++] = static_cast<std::uint32_t>(p); });
}

void MeshTexels::integrate(std::size_t chart, Chart::Rectangle rectangle, std::vector<Integral>& integrals) const {
    integrals.clear();
    if (parts_.empty()) return;
    integrals.resize(static_cast<std::size_t>(rectangle.width) * static_cast<std::size_t>(rectangle.height));
    PartIntegrator integrator(rectangle, integrals);
    const std::size_t tile =
        first_tile_[chart] +
        static_cast<std::size_t>(rectangle.y / tile_side * tiles_across(charts_[chart]) + rectangle.x / tile_side);
    for (std::size_t i = begin_[tile]; i < begin_[tile + 1]; ++i) {
        const Part& part = parts_[in_tile_[i]];
        if (!part.is_open || (!part.is_of_layers && light_.has_layers())) {
            integrator.add(part.corner, nullptr, part.is_open ? &Integral::open : &Integral::buried);
            continue;
        }
        Triangle2 as_stored = part.corner;
        if (part.is_mirrored) std::swap(as_stored[1], as_stored[2]);
        PlacedPolynomial light(as_stored);
        if (part.is_of_layers)
            light.read(light_.layer_triangle(part.triangle));
        else
            light.read(light_.mesh(), part.triangle);
        double Integral::*const area = part.is_of_layers ? nullptr : &Integral::open;
        if (!light.is_cubic()) {
            integrator.add(part.corner, &light, area);
            continue;
        }
        const Vec2 centroid = (1.0 / 3) * (part.corner[0] + part.corner[1] + part.corner[2]);
        for (std::size_t k = 0; k < 3; ++k)
            integrator.add({part.corner[k], part.corner[(k + 1) % 3], centroid}, &light, area);
    }
}

}  // namespace exitance
