#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "exitance/base/bvh.hpp"
#include "exitance/base/parallel.hpp"
#include "exitance/lab/growing_cells/cell_function.hpp"
#include "exitance/lab/growing_cells/cells_method.hpp"
#include "exitance/lab/growing_cells/gaussian_integrals.hpp"
#include "exitance/lab/growing_cells/least_squares.hpp"
#include "exitance/solve/growth_watch.hpp"

namespace exitance {
namespace {

constexpr std::size_t max_reflections = 12;
constexpr std::size_t system_steps = 1000;  ///< Maximum iterations of conjugate gradients on the mass matrix.
constexpr double negligible = 1e-6;         ///< Amplitude of a product of Gaussians below which it is omitted.

/// Integrals of Gaussians over the scene's polygons; exact at the polygons' edges.
class PolygonIntegrals {
  public:
    PolygonIntegrals(const Stage& stage, double in_plane) : in_plane_(in_plane) {
        std::vector<Box> boxes;
        for (const Piece& piece : stage.lit_pieces()) {
            Polygon p{{},
                      stage.scene.regions()[piece.region].plane.n,
                      piece.region,
                      stage.scene.material(piece.region).emits()};
            Box box;
            for (int i = 0; i < piece.patch.corner_count(); ++i)
                p.corners.push_back(piece.patch.corner(i)), box.add(p.corners.back());
            polygons_.push_back(p), boxes.push_back(box);
        }
        tree_ = Bvh(boxes);
    }

    struct Polygon {
        std::vector<Point> corners;
        Normal n;
        RegionId region;
        bool emits;
    };
    const std::vector<Polygon>& polygons() const { return polygons_; }

    /// Calls visit(polygon, integral over it, m^2) for all polygons within three widths.
    template <class Visit>
    void visit(const Gaussian& g, const Visit& visit) const {
        const double reach = 3 * g.width;
        Box box;
        box.add(g.centre - Vec3{reach, reach, reach});
        box.add(g.centre + Vec3{reach, reach, reach});
        tree_.visit_box(
            box, [&](std::uint32_t i) { visit(i, integral_over_polygon(g, polygons_[i].corners, polygons_[i].n)); });
    }

    /// Returns the integral over all polygons of g times the shares of `cells` (`share_on_plane`), m^2. g is the
    /// product of these cells' isotropic Gaussians, or of one of them and another Gaussian.
    template <class... Cells>
    double on_surface_of(const Gaussian& g, const Cells&... cells) const {
        double sum = 0;
        visit(g, [&](std::uint32_t i, double integral) {
            const Polygon& p = polygons_[i];
            sum += (share_on_plane(cells, p.corners[0], p.n) * ...) * integral;
        });
        return sum;
    }

    /// True if a cell and a polygon face each other, by the same test as for pairs of samples. A cell never faces its
    /// own surface, on which it lies up to rounding, nor coplanar polygons.
    bool face_each_other(const CellLight::Cell& cell, const std::vector<RegionId>& own, std::uint32_t i) const {
        const Polygon& p = polygons_[i];
        if (std::binary_search(own.begin(), own.end(), p.region)) return false;
        if (dot(p.n, cell.at - p.corners[0]) <= in_plane_) return false;
        return std::any_of(p.corners.begin(), p.corners.end(),
                           [&](const Point& corner) { return dot(cell.n, corner - cell.at) > in_plane_; });
    }

  private:
    double in_plane_;  ///< Coplanarity tolerance of `SurfacePool`, metres.
    std::vector<Polygon> polygons_;
    Bvh tree_;
};

/// Mass matrix G_qp = int Phi_q Phi_p over all surfaces, with Phi as `CellFunction` evaluates it.
std::vector<double> mass_matrix(const std::vector<CellLight::Cell>& cells, const PolygonIntegrals& integrals) {
    const std::size_t n = cells.size();
    std::vector<double> G(n * n);
    parallel_for(n, 4, [&](std::size_t q) {
        for (std::size_t p = 0; p <= q; ++p) {
            if (dot(cells[q].n, cells[p].n) <= 0) continue;
            const Gaussian both = product({cells[q].at, cells[q].width}, {cells[p].at, cells[p].width});
            if (both.amplitude < negligible) continue;
            G[q * n + p] = integrals.on_surface_of(both, cells[q], cells[p]);
        }
    });
    for (std::size_t q = 0; q < n; ++q)
        for (std::size_t p = 0; p < q; ++p) G[p * n + q] = G[q * n + p];
    return G;
}

/// Right-hand side rhs_q = sum_o v_o I_q(o_x) J_q(o_y) with I_q = int Phi_q(x) exp(-|x - o_x|^2 / d_o^2). J_q is the
/// same integral over y, over all sources of the network's kind that q faces.
std::vector<Spectrum> arriving(const std::vector<CellLight::Cell>& cells,
                               const std::vector<std::vector<RegionId>>& own_regions, const KernelNetwork& kernel,
                               const PolygonIntegrals& integrals, bool of_emitters) {
    const GrowingCells& network = kernel.cells();
    const std::vector<GrowingCells::Unit> units = network.units();
    std::vector<std::vector<std::pair<std::uint32_t, double>>> J(units.size());
    parallel_for(units.size(), 8, [&](std::size_t i) {
        integrals.visit({kernel.place_y(units[i]), network.width(units[i])}, [&](std::uint32_t polygon, double part) {
            if (integrals.polygons()[polygon].emits == of_emitters && part > 0) J[i].emplace_back(polygon, part);
        });
    });
    std::vector<Spectrum> out(cells.size());
    parallel_for(cells.size(), 4, [&](std::size_t q) {
        const CellLight::Cell& cell = cells[q];
        std::vector<std::uint8_t> faces(integrals.polygons().size());
        for (std::uint32_t i = 0; i < faces.size(); ++i) faces[i] = integrals.face_each_other(cell, own_regions[q], i);
        for (std::size_t i = 0; i < units.size(); ++i) {
            const Gaussian both = product({cell.at, cell.width}, {kernel.place_x(units[i]), network.width(units[i])});
            if (both.amplitude < negligible) continue;
            double sent = 0;
            for (const auto& [polygon, part] : J[i]) sent += faces[polygon] ? part : 0;
            if (!(sent > 0)) continue;
            const double I = integrals.on_surface_of(both, cell);
            const auto v = network.output(units[i]);
            for (std::size_t b = 0; b < bands; ++b) out[q][b] += v[b] * I * sent;
        }
    });
    return out;
}

/// Solves G b = rhs for the outputs of the shading network.
void solve_outputs(const std::vector<double>& G, const std::vector<Spectrum>& rhs,
                   std::vector<CellLight::Cell>& cells) {
    const std::size_t n = cells.size();
    std::vector<double> x(n), b(n);
    for (std::size_t band = 0; band < bands; ++band) {
        for (std::size_t q = 0; q < n; ++q) b[q] = rhs[q][band], x[q] = cells[q].value[band];
        solve_positive(G, b, x, system_steps);
        for (std::size_t q = 0; q < n; ++q) cells[q].value[band] = x[q];
    }
}

/// Grows the shading network. A quarter of its samples are ends of the learned rays, the rest is uniform.
ShadingNetwork grow_at_ends(const MethodInput& input, const SurfacePool& pool, const std::vector<std::uint32_t>& ends,
                            std::size_t units) {
    constexpr double by_ends = 0.25;
    const auto draw = [&](double u, double v) {
        const bool end = v < by_ends && !ends.empty();
        const auto i = static_cast<std::uint32_t>(u * static_cast<double>(end ? ends.size() : pool.size()));
        return end ? ends[i] : i;
    };
    return grow_shading_network(pool, draw, units, true, input.stage.scene.size(), input.options.seed, input.stop);
}

/// rho E at every point of the pool, W/m^2.
std::vector<Spectrum> reflected_radiosity(const Stage& stage, const SurfacePool& pool, const CellLight& light) {
    const CellFunction E(light);
    std::vector<Spectrum> out(pool.size());
    parallel_for(pool.size(), 64, [&](std::size_t i) {
        const Spectrum& rho = stage.scene.material(pool[i].region).reflectance;
        if (max(rho) > 0) out[i] = rho * E.at(pool[i].x, pool[i].n);
    });
    return out;
}

/// The outputs of the shading network's cells from the light of kernel networks: G b = rhs, with the mass matrix G.
class CellEquation {
  public:
    CellEquation(const Stage& stage, const SurfacePool& pool, const ShadingNetwork& network)
        : network_(network), integrals_(stage, pool.in_plane()), G_(mass_matrix(network.cells, integrals_)) {}

    /// Returns the right-hand side for the light of a kernel network.
    std::vector<Spectrum> arriving_from(const KernelNetwork& kernel, bool of_emitters) const {
        return arriving(network_.cells, network_.own_regions, kernel, integrals_, of_emitters);
    }
    void solve(const std::vector<Spectrum>& rhs, std::vector<CellLight::Cell>& cells) const {
        solve_outputs(G_, rhs, cells);
    }
    std::size_t memory_bytes() const { return G_.size() * sizeof(double); }

  private:
    const ShadingNetwork& network_;
    PolygonIntegrals integrals_;
    std::vector<double> G_;
};

/// Learns the reflected light in `reflected`, one reflection per round, and computes E in `out` from it and `first`,
/// the right-hand side for the light of emitters. Ends when E is settled, or grows without limit.
void learn_reflections(const MethodInput& input, const SurfacePool& pool, std::size_t units,
                       const CellEquation& equation, const std::vector<Spectrum>& first, KernelNetwork& reflected,
                       LearnedLight& out) {
    const std::size_t max_rounds = std::min(max_reflections, input.knobs.max_iterations);
    std::vector<Spectrum> B(pool.size());
    GrowthWatch watch;
    for (std::size_t round = 0; round < max_rounds && !input.stop.requested(); ++round) {
        std::vector<Spectrum> next = reflected_radiosity(input.stage, pool, out.light);
        double change = 0, all = 0;
        for (std::size_t i = 0; i < pool.size(); ++i) {
            const Spectrum& M = input.stage.scene.material(pool[i].region).exitance;
            change += mean(next[i] - B[i]), all += mean(next[i] + M);
        }
        B = std::move(next);
        out.report.iterations = round + 1;
        out.report.residual = all > 0 ? std::abs(change) / all : 0;
        input.progress.advance(static_cast<double>(round) / static_cast<double>(max_rounds),
                               fmt::format("change {:.1e}", out.report.residual));
        // Fresh samples alone cause a change of this size, so further reflections would learn nothing.
        constexpr double settled = 2e-3;
        out.report.converged = out.report.residual < std::max(settled, input.knobs.residual);
        if (out.report.converged) break;
        if (watch.grows(std::max(std::abs(change), settled * all))) {
            out.report.residual = 1;  // has_diverged
            break;
        }
        reflected.renew(B);
        if (round == 0 && !reflected.grow(units / 2, input.stop, &input.progress)) break;
        if (round > 0) reflected.learn_more(10 * units, input.stop);
        reflected.fit();
        std::vector<Spectrum> rhs = equation.arriving_from(reflected, false);
        for (std::size_t q = 0; q < rhs.size(); ++q) rhs[q] += first[q];
        equation.solve(rhs, out.light.cells);
    }
}

}  // namespace

/// Bohn's classic scheme:
/// 1. A kernel network learns G V M from rays that start on emitters: by the delta rule while it grows, then by least
///    squares.
/// 2. The shading network learns the surfaces from the rays' ends and becomes the mesh.
/// 3. Light passes through both networks by closed-form integrals, which yields E.
/// 4. A second kernel network learns G V B of the reflected light B = rho E, and E is recomputed from both networks.
///    Targets are renewed and more samples are drawn from the present sources: one reflection per round.
///
/// The networks are separate because errors of one network on surfaces that do not emit would be summed over all of
/// them.
LearnedLight learn_flow(const MethodInput& input, const SurfacePool& pool) {
    const Stage& stage = input.stage;
    const std::size_t units = units_of(stage, input.knobs, input.options);
    const auto emits = [&](const SurfacePoint& p) { return stage.scene.material(p.region).emits(); };
    const auto everything = [](const SurfacePoint&) { return true; };
    std::vector<Spectrum> M(pool.size());
    for (std::size_t i = 0; i < pool.size(); ++i) M[i] = stage.scene.material(pool[i].region).exitance;
    KernelNetworkOptions options{.target = KernelTarget::flow, .uniform_sources = 0, .seed = input.options.seed};
    KernelNetwork emitted(stage, pool, options, M);
    emitted.restrict_to(everything, emits);
    // Kernels of touching surfaces are unbounded, so they are taken between discs as large as a unit's share of the
    // surface.
    options.min_area = stage.area / std::sqrt(static_cast<double>(units));
    options.uniform_sources = 0.2;
    KernelNetwork reflected(stage, pool, options, M);
    reflected.restrict_to(everything, [&](const SurfacePoint& p) { return !emits(p); });
    LearnedLight out;
    out.light.normalised = false;
    input.progress.phase("grow");
    const bool has_light = emitted.grow(units / 2, input.stop, &input.progress);
    const ShadingNetwork network = grow_at_ends(input, pool, emitted.receivers_drawn(), units);
    out.light.cells = network.cells;
    out.light.triangles = network.triangles;
    if (!has_light) return out;
    const CellEquation equation(stage, pool, network);
    emitted.fit();
    const std::vector<Spectrum> first = equation.arriving_from(emitted, true);
    equation.solve(first, out.light.cells);
    input.progress.phase("solve");
    learn_reflections(input, pool, units, equation, first, reflected, out);
    keep_network(emitted, out.light);
    keep_network(reflected, out.light);
    out.rays = emitted.rays() + reflected.rays();
    out.kernels = emitted.sample_count() + reflected.sample_count();
    out.memory_bytes = equation.memory_bytes();
    return out;
}

}  // namespace exitance
