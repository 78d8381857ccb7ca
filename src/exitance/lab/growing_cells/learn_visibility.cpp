#include <algorithm>
#include <cmath>
#include <memory>

#include "exitance/base/parallel.hpp"
#include "exitance/base/random.hpp"
#include "exitance/basis/small_system.hpp"
#include "exitance/lab/growing_cells/cell_function.hpp"
#include "exitance/lab/growing_cells/cells_method.hpp"
#include "exitance/solve/growth_watch.hpp"

namespace exitance {
namespace {

constexpr double near_distance = 3;  ///< Cells closer than this multiple of their widths are summed point by point.
constexpr std::size_t rays_per_pair = 4;   ///< Rays per pair whose learned visibility is not sure.
constexpr std::size_t nodes_per_cell = 4;  ///< Points per cell from which it sends light, on average.
/// Length that a unit difference of normals counts as, relative to the scene's size.
constexpr double visibility_turn_by_size = 0.2;
constexpr double visibility_ridge = 0.02;  ///< Ridge of slopes, relative to the spread of a cell's neighbours.
constexpr std::size_t max_flow_reflections = 200;
constexpr double direct_accuracy = 0.01;  ///< Relative accuracy of direct light at points, if there are many emitters.

/// Points (nodes) from which cells send light.
struct Nodes {
    std::vector<std::vector<std::uint32_t>> all;  ///< Per cell: indices of its points in the pool.
    std::vector<Spectrum> mean_direct;            ///< Per cell: mean of rho E_dir, W/m^2.
    std::vector<std::uint32_t> point;             ///< Indices of the nodes in the pool, sorted by cell.
    std::vector<std::uint32_t> first;             ///< Per cell: index of its first node; one more entry at the end.
    std::vector<double> area;                     ///< Per cell: area of one node, m^2.
    std::vector<Spectrum> reflectance, reflected_direct;  ///< Per node: rho, and rho E_dir (W/m^2).
};

Nodes make_nodes(const Stage& stage, const SurfacePool& pool, const ShadingNetwork& network) {
    const std::size_t cells = network.cells.size();
    const std::size_t stride = std::max<std::size_t>(1, pool.size() / (nodes_per_cell * cells));
    std::vector<std::vector<std::uint32_t>> of_cell(cells);
    for (std::uint32_t i = 0; i < pool.size(); i += static_cast<std::uint32_t>(stride))
        of_cell[network.cell_of[i]].push_back(i);
    for (std::uint32_t i = 0; i < pool.size(); ++i)  // cells that the stride has missed
        if (of_cell[network.cell_of[i]].empty()) of_cell[network.cell_of[i]].push_back(i);
    Nodes out;
    out.all.resize(cells), out.mean_direct.resize(cells);
    for (std::uint32_t i = 0; i < pool.size(); ++i) out.all[network.cell_of[i]].push_back(i);
    for (std::size_t c = 0; c < cells; ++c) {
        out.first.push_back(static_cast<std::uint32_t>(out.point.size()));
        out.area.push_back(of_cell[c].empty() ? 0 : network.area[c] / static_cast<double>(of_cell[c].size()));
        out.point.insert(out.point.end(), of_cell[c].begin(), of_cell[c].end());
    }
    out.first.push_back(static_cast<std::uint32_t>(out.point.size()));
    out.reflectance.resize(out.point.size()), out.reflected_direct.resize(out.point.size());
    parallel_ranges(out.point.size(), 32, [&](std::size_t begin, std::size_t end) {
        PlaceLight::Workspace workspace;
        for (std::size_t i = begin; i < end; ++i) {
            const SurfacePoint& p = pool[out.point[i]];
            const Spectrum& rho = stage.scene.material(p.region).reflectance;
            out.reflectance[i] = rho;
            if (max(rho) <= 0 || stage.occluders.is_covered(p.x, p.n, p.region)) continue;
            const LightAccuracy accuracy = point_accuracy(direct_accuracy);
            out.reflected_direct[i] = rho * stage.place_light.at(p.x, p.n, p.region, accuracy, workspace).irradiance;
        }
    });
    for (std::size_t c = 0; c < cells; ++c) {
        for (std::uint32_t j = out.first[c]; j < out.first[c + 1]; ++j) out.mean_direct[c] += out.reflected_direct[j];
        if (out.first[c + 1] > out.first[c]) out.mean_direct[c] *= 1.0 / (out.first[c + 1] - out.first[c]);
    }
    return out;
}

/// Transport E = E_1 + T E between cells: T_pq = V(p, q) sum over nodes j of q of A_j G(p, j) rho_j, and E_1 likewise
/// from rho E_dir.
struct CellTransport {
    std::size_t size = 0;
    std::vector<Spectrum> matrix;  ///< Transport from cell to cell, row by row.
    std::vector<Spectrum> first;   ///< Irradiance of each cell by light that was reflected once, W/m^2.
    std::size_t kernels = 0, rays = 0;
};

/// Unoccluded light that cell q sends to the centre of another: from its nodes, or from all of its points if the cells
/// are near. Points count as discs of their area, so that the light is bounded.
struct Sent {
    Spectrum share, light;
};
Sent send(const Stage& stage, const SurfacePool& pool, const ShadingNetwork& network, const Nodes& nodes, std::size_t q,
          const CellLight::Cell& receiver) {
    Sent out;
    const auto factor = [&](const SurfacePoint& y, double area) {
        const Vec3 w = y.x - receiver.at;
        const double r2 = squared_norm(w), a = dot(w, receiver.n), b = -dot(w, y.n);
        return a > pool.in_plane() && b > pool.in_plane() ? area * a * b / (r2 * (pi * r2 + area)) : 0;
    };
    const CellLight::Cell& source = network.cells[q];
    const double reach = near_distance * (source.width + receiver.width);
    if (squared_norm(source.at - receiver.at) < reach * reach) {
        for (const std::uint32_t i : nodes.all[q]) {
            const double F = factor(pool[i], pool.area_each());
            if (F <= 0) continue;
            out.share += F * stage.scene.material(pool[i].region).reflectance;
            out.light += F * nodes.mean_direct[q];
        }
        return out;
    }
    for (std::uint32_t j = nodes.first[q]; j < nodes.first[q + 1]; ++j) {
        const double F = factor(pool[nodes.point[j]], nodes.area[q]);
        if (F <= 0) continue;
        out.share += F * nodes.reflectance[j];
        out.light += F * nodes.reflected_direct[j];
    }
    return out;
}

/// Rays between points of two cells, for the pairs of a row whose learned visibility is not sure.
class PairRays {
  public:
    PairRays(const Stage& stage, const SurfacePool& pool, const Nodes& nodes, std::uint64_t seed)
        : stage_(stage), pool_(pool), nodes_(nodes), seed_(seed) {}

    void add(std::size_t p, std::size_t q) {
        RandomStream random(seed_, Stream::visibility, p, q);
        const auto any = [&](std::size_t c) {
            const auto& points = nodes_.all[c];
            const auto i = static_cast<std::size_t>(random.uniform() * static_cast<double>(points.size()));
            return pool_[points[i]];
        };
        pairs_.push_back(q);
        for (std::size_t k = 0; k < rays_per_pair; ++k) {
            const SurfacePoint x = any(p), y = any(q);
            from_.push_back({x.x, x.region}), to_.push_back({y.x, y.region});
        }
    }
    /// Calls visit(q, unblocked share of the rays) for every pair.
    template <class Visit>
    void trace(const Visit& visit) {
        const std::unique_ptr<bool[]> blocked(new bool[from_.size()]);
        if (!from_.empty()) stage_.tracer.occluded(from_, to_, {blocked.get(), from_.size()});
        for (std::size_t i = 0; i < pairs_.size(); ++i) {
            double seen = 0;
            for (std::size_t k = 0; k < rays_per_pair; ++k)
                seen += blocked[i * rays_per_pair + k] ? 0 : 1.0 / rays_per_pair;
            visit(pairs_[i], seen);
        }
    }
    std::size_t count() const { return from_.size(); }

  private:
    const Stage& stage_;
    const SurfacePool& pool_;
    const Nodes& nodes_;
    std::uint64_t seed_;
    std::vector<std::size_t> pairs_;
    std::vector<RayEnd> from_, to_;
};

CellTransport make_transport(const Stage& stage, const SurfacePool& pool, const ShadingNetwork& network,
                             const Nodes& nodes, const KernelNetwork& kernel, std::uint64_t seed) {
    const std::size_t n = network.cells.size();
    CellTransport T{n, std::vector<Spectrum>(n * n), std::vector<Spectrum>(n), n * nodes.point.size(), 0};
    std::vector<std::size_t> rays(n);
    parallel_for(n, 4, [&](std::size_t p) {
        const CellLight::Cell& receiver = network.cells[p];
        PairRays unsure(stage, pool, nodes, seed);
        std::vector<Spectrum> light(n);
        for (std::size_t q = 0; q < n; ++q) {
            const Sent sent = send(stage, pool, network, nodes, q, receiver);
            if (!(max(sent.share) > 0)) continue;
            const CellLight::Cell& source = network.cells[q];
            const auto [V, is_sure] = kernel.seen(receiver.at, receiver.n, source.at, source.n);
            if (!is_sure) unsure.add(p, q);
            T.matrix[p * n + q] = V * sent.share;
            light[q] = V * sent.light;
            if (!is_sure) T.matrix[p * n + q] = sent.share, light[q] = sent.light;
        }
        unsure.trace([&](std::size_t q, double seen) { T.matrix[p * n + q] *= seen, light[q] *= seen; });
        for (const Spectrum& l : light) T.first[p] += l;
        rays[p] = unsure.count();
    });
    for (const std::size_t r : rays) T.rays += r;
    return T;
}

/// Light that cells on diffusing panes receive from both sides: rows of the transport are mixed according to
/// `Material::through`. Each node of a cell takes the light from behind from the cell of the nearest node on the other
/// side.
class PassedToCells {
  public:
    PassedToCells(const Stage& stage, const SurfacePool& pool, const ShadingNetwork& network, const Nodes& nodes)
        : own_(network.cells.size(), 1.0), behind_(network.cells.size()) {
        if (!stage.scene.has_diffusing_panes()) return;
        Field<RegionId, std::vector<std::uint32_t>> of_region(stage.scene.regions().size());
        for (const std::uint32_t i : nodes.point) of_region[pool[i].region].push_back(i);
        parallel_for(own_.size(), 16, [&](std::size_t c) {
            const std::uint32_t first = nodes.first[c], last = nodes.first[c + 1];
            for (std::uint32_t j = first; j < last; ++j) {
                const SurfacePoint& p = pool[nodes.point[j]];
                const RegionId behind = stage.scene.behind(p.region);
                if (behind.is_none() || of_region[behind].empty()) continue;
                const auto is_nearer = [&](std::uint32_t a, std::uint32_t b) {
                    return squared_norm(pool[a].x - p.x) < squared_norm(pool[b].x - p.x);
                };
                const std::vector<std::uint32_t>& there = of_region[behind];
                const double share = stage.scene.material(p.region).through / (last - first);
                own_[c] -= share;
                behind_[c].push_back(
                    {network.cell_of[*std::min_element(there.begin(), there.end(), is_nearer)], share});
            }
        });
    }

    void meet(CellTransport& T) const {
        const std::vector<Spectrum> matrix = T.matrix, first = T.first;
        for (std::size_t c = 0; c < T.size; ++c) {
            if (behind_[c].empty()) continue;
            T.first[c] *= own_[c];
            for (std::size_t q = 0; q < T.size; ++q) T.matrix[c * T.size + q] *= own_[c];
            for (const auto& [other, share] : behind_[c]) {
                T.first[c] += share * first[other];
                for (std::size_t q = 0; q < T.size; ++q) T.matrix[c * T.size + q] += share * matrix[other * T.size + q];
            }
        }
    }
    bool empty() const {
        return std::all_of(behind_.begin(), behind_.end(), [](const auto& shares) { return shares.empty(); });
    }

  private:
    struct Share {
        std::uint32_t cell;
        double share;
    };
    std::vector<double> own_;  ///< Per cell on a pane: weight of the light that arrives on the cell's side.
    std::vector<std::vector<Share>> behind_;
};

/// Sums E = E_1 + T E_1 + T^2 E_1 + ..., one reflection per term. `area`: area of the cells, m^2.
SolveReport reflect(const CellTransport& T, std::span<const double> area, std::vector<Spectrum>& E, double residual,
                    std::size_t max_iterations, const StopRequest& stop) {
    const std::size_t n = T.size;
    std::vector<Spectrum> last = T.first, next(n);
    E = T.first;
    const auto size = [](const std::vector<Spectrum>& v) {
        double sum = 0;
        for (const Spectrum& s : v) sum += squared(s);
        return std::sqrt(sum);
    };
    const auto flux = [&](const std::vector<Spectrum>& v) {
        double sum = 0;
        for (std::size_t c = 0; c < n; ++c) sum += area[c] * mean(v[c]);
        return sum;
    };
    const double whole = size(E);
    GrowthWatch watch;
    watch.grows(flux(E));
    SolveReport report{.iterations = 0, .residual = 1, .converged = !(whole > 0)};
    if (report.converged) report.residual = 0;
    while (!report.converged && report.iterations < max_iterations && !stop.requested()) {
        parallel_for(n, 16, [&](std::size_t p) {
            Spectrum sum;
            for (std::size_t q = 0; q < n; ++q) sum += T.matrix[p * n + q] * last[q];
            next[p] = sum;
        });
        for (std::size_t p = 0; p < n; ++p) E[p] += next[p];
        std::swap(last, next);
        ++report.iterations;
        report.residual = size(last) / whole;
        report.converged = report.residual <= residual;
        if (watch.grows(flux(last))) {  // the series diverges, as with far too few units
            report.converged = false, report.residual = std::max(1.0, report.residual);  // has_diverged
            break;
        }
    }
    return report;
}

/// Computes the slope of every cell: a plane through its value, fitted to the cells around it by least squares.
void find_slopes(CellLight& light) {
    const CellFunction around(light);
    std::vector<std::array<Spectrum, 3>> slopes(light.cells.size());
    parallel_for(light.cells.size(), 16, [&](std::size_t c) {
        const CellLight::Cell& cell = light.cells[c];
        std::vector<double> A(9), b(3 * bands);
        double spread = 0;
        around.visit(cell.at, cell.n, [&](std::uint32_t other, double weight) {
            const CellLight::Cell& o = light.cells[other];
            const Vec3 w = o.at - cell.at;
            for (std::size_t i = 0; i < 3; ++i) {
                for (std::size_t j = 0; j < 3; ++j) A[3 * i + j] += weight * w[i] * w[j];
                for (std::size_t k = 0; k < bands; ++k)
                    b[bands * i + k] += weight * w[i] * (o.value[k] - cell.value[k]);
            }
            spread += weight * squared_norm(w);
        });
        if (!(spread > 0)) return;
        for (std::size_t i = 0; i < 3; ++i) A[4 * i] += visibility_ridge * spread;
        solve_in_place(A, b, 3, bands);
        for (std::size_t i = 0; i < 3; ++i) std::copy_n(&b[bands * i], bands, slopes[c][i].value.begin());
    });
    for (std::size_t c = 0; c < slopes.size(); ++c) light.cells[c].slope = slopes[c];
}

}  // namespace

/// The improved scheme:
/// 1. The shading network grows uniformly over all surfaces.
/// 2. Exact direct light is computed at points of every cell.
/// 3. The kernel network learns visibility, with half of its units, from the sources of direct light.
/// 4. Light is reflected.
/// 5. The kernel network grows further, with all light as sources.
/// 6. Light is reflected again, and slopes are computed.
LearnedLight learn_visibility(const MethodInput& input, const SurfacePool& pool) {
    const Stage& stage = input.stage;
    const std::size_t units = units_of(stage, input.knobs, input.options);
    LearnedLight out;
    input.progress.phase("grow");
    ShadingNetwork network = grow_shading_network(
        pool, [&](double u, double) { return static_cast<std::uint32_t>(u * static_cast<double>(pool.size())); }, units,
        false, stage.scene.size(), input.options.seed, input.stop);
    const Nodes nodes = make_nodes(stage, pool, network);
    const PassedToCells passed(stage, pool, network, nodes);
    std::vector<Spectrum> cell_light(network.cells.size()), sent(pool.size());
    for (std::size_t c = 0; c < cell_light.size(); ++c) {
        cell_light[c] = nodes.mean_direct[c];
    }
    for (std::size_t i = 0; i < pool.size(); ++i) sent[i] = cell_light[network.cell_of[i]];
    KernelNetwork kernel(stage, pool,
                         {.target = KernelTarget::visibility,
                          .normal_scale = visibility_turn_by_size * stage.scene.size(),
                          .seed = input.options.seed},
                         sent);
    out.light.cells = network.cells;
    out.light.triangles = network.triangles;
    std::vector<Spectrum> E(network.cells.size());
    for (const std::size_t part : {std::size_t(2), std::size_t(1)}) {
        if (!kernel.grow(units / part, input.stop, &input.progress)) break;  // no points face each other
        kernel.fit();
        input.progress.phase("solve");
        CellTransport T = make_transport(stage, pool, network, nodes, kernel, input.options.seed);
        if (!passed.empty()) passed.meet(T);
        out.report = reflect(T, network.area, E, input.knobs.residual,
                             std::min(max_flow_reflections, input.knobs.max_iterations), input.stop);
        out.kernels += T.kernels, out.rays += T.rays;
        out.memory_bytes = T.matrix.size() * sizeof(Spectrum);
        for (std::size_t i = 0; i < pool.size(); ++i) {
            const std::uint32_t c = network.cell_of[i];
            sent[i] = cell_light[c] + stage.scene.material(pool[i].region).reflectance * E[c];
        }
        if (part == 2) kernel.renew(sent), input.progress.phase("grow");
    }
    for (std::size_t c = 0; c < E.size(); ++c) out.light.cells[c].value = E[c];
    find_slopes(out.light);
    keep_network(kernel, out.light);
    out.rays += kernel.rays();
    return out;
}

/// Between surfaces, as many units are removed as inserted until growth ends. In so small a network, all units near a
/// pair agree on visibility only if nothing blocks any pair of surfaces. Otherwise rays determine it, in both rounds.
MethodForecast forecast_cells(const Stage& stage, const SolveOptions& options, const Knobs& knobs, double facing,
                              bool blocked) {
    // maximum per sample: measured values are 12 (chairs in a room) to 79 (the Cornell box)
    constexpr double units_near = 80;
    constexpr double insertions = 2;     // insertions per requested unit
    constexpr double vector_room = 1.5;  // capacity of growing vectors per size, on average
    const double n = static_cast<double>(units_of(stage, knobs, options));
    const double samples = insertions * static_cast<double>(KernelNetworkOptions().samples_a_unit) * n;
    MethodForecast out{.rays = samples, .bytes = sizeof(Spectrum) * n * n};
    if (blocked) out.rays += 2 * facing * n * n * rays_per_pair;
    out.bytes += samples * units_near * vector_room * sizeof(std::pair<std::uint32_t, double>);
    return out;
}

}  // namespace exitance
