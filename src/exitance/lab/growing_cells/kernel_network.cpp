#include "exitance/lab/growing_cells/kernel_network.hpp"

#include <algorithm>
#include <cmath>

#include "exitance/base/parallel.hpp"
#include "exitance/base/random.hpp"
#include "exitance/basis/small_system.hpp"
#include "exitance/lab/growing_cells/least_squares.hpp"

namespace exitance {
namespace {

constexpr std::size_t simplex = 4;              ///< Dimension of a simplex: rays are a four-dimensional manifold.
constexpr std::size_t samples_per_weight = 40;  ///< Samples per weight in the least-squares fit of flow.
constexpr std::size_t max_tries = 64;           ///< Attempts to draw a pair of points that face each other, per pair.
/// Weight, in fits over all pairs, of samples drawn near units with a large resource.
constexpr double resampled_weight = 0.3;
/// A unit is idle if it wins less than this share of the mean number of samples per unit. Units between surfaces win
/// almost none.
constexpr double idle_share = 0.01;
constexpr std::size_t thinnings = 4;  ///< Searches for idle units while a network doubles in size.
/// Growth ends after this number of insertions without a net gain, or after the number of units if that is larger.
constexpr std::size_t max_vain_insertions = 64;
constexpr double sure_share = 1e-3;      ///< Share of differing samples up to which a visibility is sure.
constexpr double map_width_share = 0.6;  ///< Width of a linear map's unit, relative to its edges: maps extrapolate.
constexpr double density_share = 0.05;   ///< Resource that every sample adds, relative to its mean squared target.
constexpr double slope_ridge = 1e-2;     ///< Ridge of linear maps, relative to the spread of samples around their unit.

}  // namespace

double point_kernel(const Point& x, const Normal& n_x, const Point& y, const Normal& n_y, double in_plane) {
    const Vec3 w = y - x;
    const double r2 = squared_norm(w), a = dot(w, n_x), b = -dot(w, n_y);
    return a > in_plane && b > in_plane ? a * b / (pi * r2 * r2) : 0;
}

KernelNetwork::KernelNetwork(const Stage& stage, const SurfacePool& pool, const KernelNetworkOptions& options,
                             std::span<const Spectrum> radiosity)
    : stage_(stage), pool_(pool), options_(options) {
    const auto all = [](const SurfacePoint&) { return true; };
    is_receiver_ = all, is_source_ = all;
    renew(radiosity);
    restrict_to(all, all);
}

void KernelNetwork::restrict_to(std::function<bool(const SurfacePoint&)> is_receiver,
                                std::function<bool(const SurfacePoint&)> is_source) {
    is_receiver_ = std::move(is_receiver), is_source_ = std::move(is_source);
    receivers_.clear();
    for (std::uint32_t i = 0; i < pool_.size(); ++i)
        if (is_receiver_(pool_[i])) receivers_.push_back(i);
    renew(std::vector<Spectrum>(radiosity_));
}

void KernelNetwork::renew(std::span<const Spectrum> radiosity) {
    radiosity_.assign(radiosity.begin(), radiosity.end());
    double total = 0;
    for (std::size_t i = 0; i < pool_.size(); ++i) total += is_source_(pool_[i]) ? mean(radiosity_[i]) : 0;
    const double uniform = total > 0 ? options_.uniform_sources : 1;
    source_sum_.assign(pool_.size() + 1, 0);
    for (std::size_t i = 0; i < pool_.size(); ++i) {
        const double by_light = total > 0 ? (1 - uniform) * mean(radiosity_[i]) / total : 0;
        const double share = is_source_(pool_[i]) ? by_light + uniform / static_cast<double>(pool_.size()) : 0;
        source_sum_[i + 1] = source_sum_[i] + share;
    }
}

std::uint32_t KernelNetwork::draw_source(double u) const {
    const auto at = std::upper_bound(source_sum_.begin(), source_sum_.end(), u * source_sum_.back());
    const auto i = static_cast<std::size_t>(at - source_sum_.begin());
    return static_cast<std::uint32_t>(std::clamp<std::size_t>(i, 1, pool_.size()) - 1);
}

double KernelNetwork::kernel(const Sample& s) const {
    return point_kernel(pool_[s.x].x, pool_[s.x].n, pool_[s.y].x, pool_[s.y].n, pool_.in_plane());
}
Spectrum KernelNetwork::flow(const Sample& s) const {
    double G = s.visible ? kernel(s) : 0;
    if (G > 0 && options_.min_area > 0) {
        const double disc = pi * squared_norm(pool_[s.x].x - pool_[s.y].x);
        G *= disc / (disc + options_.min_area);
    }
    return G * radiosity_[s.y];
}

std::vector<double> KernelNetwork::coordinates(const Point& x, const Normal& n_x, const Point& y,
                                               const Normal& n_y) const {
    std::vector<double> out{x.x, x.y, x.z, y.x, y.y, y.z};
    if (options_.normal_scale > 0)
        for (const Normal& n : {n_x, n_y})
            for (std::size_t axis = 0; axis < 3; ++axis) out.push_back(options_.normal_scale * n[axis]);
    return out;
}
std::vector<double> KernelNetwork::coordinates(const Sample& s) const {
    return coordinates(pool_[s.x].x, pool_[s.x].n, pool_[s.y].x, pool_[s.y].n);
}

/// Draws pairs that face each other. A share of them are drawn near the last sample that a unit won, with units chosen
/// in proportion to their resource.
void KernelNetwork::draw(std::size_t count, std::vector<Sample>& out) {
    out.clear();
    if (receivers_.empty() || !(source_sum_.back() > 0)) return;
    std::vector<GrowingCells::Unit> units;
    std::vector<double> sum{0};
    if (cells_)
        for (const GrowingCells::Unit u : cells_->units())
            if (u < last_won_.size() && last_won_[u] != no_unit) {
                units.push_back(u);
                sum.push_back(sum.back() + cells_->resource(u));
            }
    RandomStream random(options_.seed, Stream::shooting, 77, drawn_++);
    for (std::size_t tries = 0; out.size() < count && tries < max_tries * count; ++tries) {
        Sample s;
        s.resampled = !units.empty() && sum.back() > 0 && random.uniform() < options_.resampled;
        if (s.resampled) {
            const auto at = std::upper_bound(sum.begin() + 1, sum.end(), random.uniform() * sum.back());
            const GrowingCells::Unit u =
                units[std::min<std::size_t>(units.size() - 1, static_cast<std::size_t>(at - sum.begin()) - 1)];
            const Sample& won = samples_[last_won_[u]];
            const double reach = 0.5 * cells_->width(u);
            s.x = pool_.near(won.x, reach, random.uniform());
            s.y = pool_.near(won.y, reach, random.uniform());
            if (!is_receiver_(pool_[s.x]) || !is_source_(pool_[s.y])) continue;
        } else {
            s.x = receivers_[static_cast<std::size_t>(random.uniform() * static_cast<double>(receivers_.size()))];
            s.y = draw_source(random.uniform());
        }
        if (kernel(s) > 0) out.push_back(s);
    }
    std::vector<RayEnd> from, to;
    for (const Sample& s : out) {
        from.push_back({pool_[s.x].x, pool_[s.x].region});
        to.push_back({pool_[s.y].x, pool_[s.y].region});
    }
    const std::unique_ptr<bool[]> blocked(new bool[out.size()]);
    constexpr std::size_t packet = 64;
    parallel_ranges(out.size(), packet, [&](std::size_t first, std::size_t last) {
        stage_.tracer.occluded(std::span(from).subspan(first, last - first), std::span(to).subspan(first, last - first),
                               {&blocked[first], last - first});
    });
    for (std::size_t i = 0; i < out.size(); ++i) out[i].visible = !blocked[i];
    rays_ += out.size();
}

/// Makes the first units at samples that are spread over the batch.
void KernelNetwork::make_cells(std::vector<Sample>& first) {
    const std::size_t n = options_.normal_scale > 0 ? 12 : 6;
    std::vector<double> corners;
    for (std::size_t i = 0; i <= simplex; ++i) {
        const std::vector<double> at = coordinates(first[i * (first.size() - 1) / simplex]);
        corners.insert(corners.end(), at.begin(), at.end());
    }
    const bool maps = options_.target == KernelTarget::visibility;
    cells_ = std::make_unique<GrowingCells>(GrowingCellsOptions{.simplex = simplex,
                                                                .dimension = n,
                                                                .outputs = outputs(),
                                                                .width_share = maps ? map_width_share : 1.0,
                                                                .normalised = maps},
                                            corners);
}

void KernelNetwork::learn(const Sample& s) {
    std::vector<double> target(outputs(), s.visible ? 1.0 : 0.0);
    double weight = 1;
    if (options_.target == KernelTarget::flow) {
        const Spectrum light = flow(s);
        std::copy(light.value.begin(), light.value.end(), target.begin());
    } else {
        weight = kernel(s) * mean(radiosity_[s.y]);  // an error of V counts by the light that the ray would transport
        weight *= weight;
    }
    const std::vector<double> at = coordinates(s);
    const GrowingCells::Unit winner = cells_->winner(at);
    double size = 0;
    for (const double v : target) size += v * v;
    cells_->learn(at, target, density_share * weight * size, weight);
    if (last_won_.size() <= winner) last_won_.resize(winner + 1, no_unit);
    last_won_[winner] = static_cast<std::uint32_t>(samples_.size());
    samples_.push_back(s);
}

void KernelNetwork::learn_more(std::size_t count, const StopRequest& stop) {
    std::vector<Sample> fresh;
    while (count > 0 && !stop.requested()) {
        draw(std::min(count, options_.samples_a_unit), fresh);
        if (fresh.empty()) return;
        for (const Sample& s : fresh) learn(s);
        count -= std::min(count, fresh.size());
    }
}

bool KernelNetwork::grow(std::size_t units, const StopRequest& stop, Progress* progress) {
    std::vector<Sample> fresh;
    maps_.clear();
    if (!cells_) {
        draw(options_.samples_a_unit, fresh);
        if (fresh.size() < simplex + 1) return false;
        make_cells(fresh);
        for (const Sample& s : fresh) learn(s);
    }
    std::size_t max_count = 0, max_count_at = inserted_;
    while (cells_->unit_count() < units && !stop.requested()) {
        if (cells_->unit_count() > max_count) max_count = cells_->unit_count(), max_count_at = inserted_;
        if (inserted_ - max_count_at > std::max(max_vain_insertions, max_count)) return true;
        draw(options_.samples_a_unit, fresh);
        if (fresh.empty()) return false;
        for (const Sample& s : fresh) learn(s);
        cells_->insert();
        // Edges across folds are long, so that units end up between surfaces: remove those that win nothing.
        ++inserted_;
        if (options_.normal_scale > 0 && ++since_look_ > 8 + cells_->unit_count() / thinnings)
            cells_->remove_idle(idle_share, false), since_look_ = 0;
        if (progress && cells_->unit_count() % 32 == 0)
            progress->advance(static_cast<double>(cells_->unit_count()) / static_cast<double>(units));
    }
    return true;
}

void KernelNetwork::fit() {
    cells_->refresh();
    options_.target == KernelTarget::flow ? fit_flow() : fit_maps();
}

std::vector<std::uint32_t> KernelNetwork::receivers_drawn() const {
    std::vector<std::uint32_t> out;
    for (const Sample& s : samples_) out.push_back(s.x);
    return out;
}

void KernelNetwork::fit_flow() {
    // A subset of samples is enough to determine the weights, and faster.
    const std::size_t stride = std::max<std::size_t>(1, samples_.size() / (samples_per_weight * cells_->unit_count()));
    const std::vector<GrowingCells::Unit> units = cells_->units();
    std::vector<std::uint32_t> number(cells_->complex().unit_end());
    for (std::uint32_t i = 0; i < units.size(); ++i) number[units[i]] = i;
    std::vector<double> values;
    for (const GrowingCells::Unit u : units) {
        const auto out = std::as_const(*cells_).output(u);
        values.insert(values.end(), out.begin(), out.end());
    }
    FitProblem problem;
    problem.samples = samples_.size() / stride, problem.unknowns = units.size(), problem.outputs = bands;
    problem.row = [&](std::size_t s, FitRow& row) {
        cells_->visit(coordinates(samples_[s * stride]),
                      [&](GrowingCells::Unit u, double w) { row.emplace_back(number[u], w); });
    };
    problem.target = [&](std::size_t s, std::size_t band) { return flow(samples_[s * stride])[band]; };
    problem.weight = [&](std::size_t s) { return samples_[s * stride].resampled ? resampled_weight : 1.0; };
    fit_least_squares(problem, values);
    for (std::size_t i = 0; i < units.size(); ++i)
        std::copy_n(&values[i * bands], bands, cells_->output(units[i]).begin());
}

/// Fits a linear map to the samples around every unit, weighted by its Gaussian.
void KernelNetwork::fit_maps() {
    constexpr std::size_t size = 7;
    const std::size_t end = cells_->complex().unit_end();
    std::vector<std::vector<std::pair<std::uint32_t, double>>> of_unit(end);
    constexpr std::size_t block = 2048;
    std::vector<FitRow> rows(block);
    for (std::size_t first = 0; first < samples_.size(); first += block) {
        const std::size_t count = std::min(block, samples_.size() - first);
        parallel_for(count, 64, [&](std::size_t i) {
            rows[i].clear();
            cells_->visit(coordinates(samples_[first + i]),
                          [&](GrowingCells::Unit u, double w) { rows[i].emplace_back(u, w); });
        });
        for (std::size_t i = 0; i < count; ++i)
            for (const auto& [u, w] : rows[i]) of_unit[u].emplace_back(static_cast<std::uint32_t>(first + i), w);
    }
    maps_.assign(end, {});
    seen_.assign(end, -1);
    parallel_for(end, 8, [&](std::size_t u) {
        if (!cells_->complex().has_unit(static_cast<GrowingCells::Unit>(u))) return;
        const auto unit = static_cast<GrowingCells::Unit>(u);
        std::vector<double> A(size * size), b(size);
        double weights = 0, visible = 0;
        for (const auto& [index, gaussian] : of_unit[u]) {
            const Sample& s = samples_[index];
            const std::vector<double> at = coordinates(s);
            const double w = gaussian * (s.resampled ? resampled_weight : 1.0);
            std::array<double, size> row{1};
            for (std::size_t i = 1; i < size; ++i) row[i] = at[i - 1] - cells_->position(unit)[i - 1];
            for (std::size_t i = 0; i < size; ++i) {
                for (std::size_t j = 0; j < size; ++j) A[i * size + j] += w * row[i] * row[j];
                b[i] += w * row[i] * (s.visible ? 1.0 : 0.0);
            }
            weights += w;
            visible += s.visible ? w : 0;
        }
        if (weights > 0) seen_[u] = visible / weights;
        const double scale = weights * cells_->width(unit) * cells_->width(unit);
        if (!(weights > 0)) {
            maps_[u][0] = cells_->output(unit)[0];
            return;
        }
        for (std::size_t i = 0; i < size; ++i) A[i * size + i] += i == 0 ? 1e-9 * weights : slope_ridge * scale;
        solve_in_place(A, b, size, 1);
        std::copy(b.begin(), b.end(), maps_[u].begin());
    });
}

std::vector<double> KernelNetwork::outputs_as_learned() const {
    std::vector<double> out;
    for (const GrowingCells::Unit u : cells_->units()) {
        const auto own = std::as_const(*cells_).output(u);
        out.insert(out.end(), own.begin(), own.end());
    }
    return out;
}
void KernelNetwork::restore_outputs(std::span<const double> outputs_then) {
    std::size_t at = 0;
    for (const GrowingCells::Unit u : cells_->units())
        for (double& v : cells_->output(u)) v = outputs_then[at++];
    maps_.clear();
}

double KernelNetwork::visibility(const Point& x, const Normal& n_x, const Point& y, const Normal& n_y) const {
    const std::vector<double> at = coordinates(x, n_x, y, n_y);
    double sum = 0, weights = 0;
    cells_->visit(at, [&](GrowingCells::Unit u, double w) {
        double answer = maps_[u][0];
        for (std::size_t i = 0; i < 6; ++i) answer += maps_[u][i + 1] * (at[i] - cells_->position(u)[i]);
        sum += w * answer;
        weights += w;
    });
    return weights > 0 ? sum / weights : maps_[cells_->winner(at)][0];
}

KernelNetwork::Seen KernelNetwork::seen(const Point& x, const Normal& n_x, const Point& y, const Normal& n_y) const {
    double sum = 0, weights = 0;
    cells_->visit(coordinates(x, n_x, y, n_y), [&](GrowingCells::Unit u, double w) {
        if (seen_[u] < 0) return;
        sum += w * seen_[u], weights += w;
    });
    const double share = weights > 0 ? sum / weights : 0.5;
    return {share, share < sure_share || share > 1 - sure_share};
}

Spectrum KernelNetwork::evaluate(const Point& x, const Normal& n_x, const Point& y, const Normal& n_y) const {
    if (!maps_.empty()) return Spectrum(std::clamp(visibility(x, n_x, y, n_y), 0.0, 1.0));
    std::array<double, bands> out{};
    cells_->evaluate(coordinates(x, n_x, y, n_y), std::span(out).first(outputs()));
    Spectrum answer;
    for (std::size_t b = 0; b < bands; ++b) answer[b] = out[outputs() == 1 ? 0 : b];
    return answer;
}

Point KernelNetwork::place_x(GrowingCells::Unit u) const {
    const auto at = cells_->position(u);
    return {at[0], at[1], at[2]};
}
Point KernelNetwork::place_y(GrowingCells::Unit u) const {
    const auto at = cells_->position(u);
    return {at[3], at[4], at[5]};
}

std::size_t KernelNetwork::bytes_a_unit() const {
    // Position, width and outputs in double precision; for visibility the map instead of an output.
    const std::size_t n = cells_->options().dimension;
    return sizeof(double) * (n + 1 + (options_.target == KernelTarget::flow ? bands : 7));
}

}  // namespace exitance
