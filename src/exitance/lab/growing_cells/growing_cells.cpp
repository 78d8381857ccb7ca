#include "exitance/lab/growing_cells/growing_cells.hpp"

#include <algorithm>
#include <limits>

#include "exitance/base/check.hpp"

namespace exitance {
namespace {

constexpr std::uint32_t leaf_size = 8;
constexpr double max_increment = 1e12;  ///< Resources are rescaled above this.
constexpr double min_width = 1e-9;      ///< Width of units that coincide.

}  // namespace

GrowingCells::GrowingCells(const GrowingCellsOptions& options, std::span<const double> corners)
    : options_(options),
      complex_(options.simplex),
      position_(corners.begin(), corners.end()),
      output_((options.simplex + 1) * options.outputs),
      resource_(options.simplex + 1),
      width_(options.simplex + 1),
      signals_(options.simplex + 1) {
    EXI_CHECK(corners.size() == (options.simplex + 1) * options.dimension);
    refresh();
}

std::vector<GrowingCells::Unit> GrowingCells::units() const {
    std::vector<Unit> out;
    for (Unit u = 0; u < complex_.unit_end(); ++u)
        if (complex_.has_unit(u)) out.push_back(u);
    return out;
}

double GrowingCells::measured_width(Unit u) const {
    double sum = 0;
    const auto around = complex_.neighbours(u);
    for (const Unit c : around) sum += std::sqrt(distance_squared(c, position(u)));
    return std::max(min_width, around.empty() ? 0 : sum / static_cast<double>(around.size()));
}

void GrowingCells::refresh() {
    items_ = units();
    tail_.clear(), nodes_.clear(), boxes_.clear();
    mean_width_ = 0;
    for (const Unit u : items_) {
        width_[u] = options_.width_share * measured_width(u);
        mean_width_ += width_[u] / options_.width_share / static_cast<double>(items_.size());
    }
    indexed_at_ = position_;
    drift_ = 0;
    nodes_.emplace_back();
    boxes_.resize(2 * options_.dimension);
    build(0, 0, static_cast<std::uint32_t>(items_.size()));
}

void GrowingCells::build(std::uint32_t node, std::uint32_t first, std::uint32_t count) {
    const std::size_t n = options_.dimension;
    std::size_t widest = 0;
    double extent = -1;
    for (std::size_t axis = 0; axis < n; ++axis) {
        double lo = HUGE_VAL, hi = -HUGE_VAL;
        for (std::uint32_t i = first; i < first + count; ++i) {
            const double v = position_[items_[i] * n + axis];
            lo = std::min(lo, v), hi = std::max(hi, v);
        }
        boxes_[node * 2 * n + axis] = lo, boxes_[node * 2 * n + n + axis] = hi;
        if (hi - lo > extent) extent = hi - lo, widest = axis;
    }
    double most = 0;
    for (std::uint32_t i = first; i < first + count; ++i) most = std::max(most, width_[items_[i]]);
    nodes_[node].reach = std::sqrt(cutoff) * most;
    if (count <= leaf_size) {
        nodes_[node].first = first, nodes_[node].count = count;
        return;
    }
    const std::uint32_t half = count / 2;
    const auto begin = items_.begin() + first;
    std::nth_element(begin, begin + half, begin + count, [&](Unit a, Unit b) {
        const double x = position_[a * n + widest], y = position_[b * n + widest];
        return x < y || (x == y && a < b);
    });
    const auto children = static_cast<std::uint32_t>(nodes_.size());
    nodes_[node].first = children, nodes_[node].count = 0;
    nodes_.resize(nodes_.size() + 2);
    boxes_.resize(nodes_.size() * 2 * n);
    build(children, first, half);
    build(children + 1, first + half, count - half);
}

double GrowingCells::box_distance(std::uint32_t node, std::span<const double> x) const {
    const std::size_t n = options_.dimension;
    const double* lo = &boxes_[node * 2 * n];
    double sum = 0;
    for (std::size_t i = 0; i < n; ++i) {
        const double d = std::max({lo[i] - x[i], x[i] - lo[n + i], 0.0});
        sum += d * d;
    }
    return std::sqrt(sum);
}

GrowingCells::Unit GrowingCells::winner(std::span<const double> sample) const {
    Unit best = CellComplex::none;
    double least = HUGE_VAL;
    const auto look_at = [&](Unit u) {
        if (!complex_.has_unit(u)) return;
        const double d = distance_squared(u, sample);
        if (d < least || (d == least && u < best)) least = d, best = u;
    };
    for (const Unit u : tail_) look_at(u);
    struct Open {
        std::uint32_t node;
        double distance;
    };
    Open stack[64];
    std::size_t top = 0;
    stack[top++] = {0, 0};
    while (top > 0) {
        const auto [at, distance] = stack[--top];
        const double sure = std::max(0.0, distance - drift_);
        if (sure * sure > least) continue;
        const Node& node = nodes_[at];
        if (node.count > 0) {
            for (std::uint32_t i = node.first; i < node.first + node.count; ++i) look_at(items_[i]);
            continue;
        }
        const double first = box_distance(node.first, sample), second = box_distance(node.first + 1, sample);
        const bool turned = second < first;
        stack[top++] = turned ? Open{node.first, first} : Open{node.first + 1, second};
        stack[top++] = turned ? Open{node.first + 1, second} : Open{node.first, first};
    }
    return best;
}

void GrowingCells::evaluate(std::span<const double> x, std::span<double> out) const {
    std::fill(out.begin(), out.end(), 0.0);
    double sum = 0;
    visit(x, [&](Unit u, double weight) {
        sum += weight;
        for (std::size_t b = 0; b < out.size(); ++b) out[b] += weight * output_[u * options_.outputs + b];
    });
    if (!options_.normalised) return;
    if (sum > 0) {
        for (double& v : out) v /= sum;
    } else {
        const auto own = output(winner(x));
        std::copy(own.begin(), own.end(), out.begin());
    }
}

void GrowingCells::move(Unit u, std::span<const double> towards, double rate) {
    const std::size_t n = options_.dimension;
    double moved = 0;
    for (std::size_t i = 0; i < n; ++i) {
        double& w = position_[u * n + i];
        w += rate * (towards[i] - w);
        if (u * n < indexed_at_.size()) moved += (w - indexed_at_[u * n + i]) * (w - indexed_at_[u * n + i]);
    }
    drift_ = std::max(drift_, std::sqrt(moved));
}

double GrowingCells::learn(std::span<const double> sample, std::span<const double> target, double density,
                           double error) {
    const Unit s = winner(sample);
    double squared_error = 0;
    if (options_.outputs > 0) {
        active_.clear();
        double sum = 0, squares = 0;
        visit(sample, [&](Unit u, double weight) { active_.emplace_back(u, weight), sum += weight; });
        if (active_.empty()) active_.emplace_back(s, 1.0), sum = 1;
        if (options_.normalised)
            for (auto& [u, weight] : active_) weight /= sum;
        for (const auto& [u, weight] : active_) squares += weight * weight;
        for (std::size_t b = 0; b < options_.outputs; ++b) {
            double answer = 0;
            for (const auto& [u, weight] : active_) answer += weight * output_[u * options_.outputs + b];
            const double off = target[b] - answer;
            squared_error += off * off;
            const double step = options_.output_rate * off / (options_.normalised ? squares : std::max(1.0, squares));
            for (const auto& [u, weight] : active_) output_[u * options_.outputs + b] += step * weight;
        }
    }
    move(s, sample, options_.winner_rate);
    for (const Unit c : complex_.neighbours(s)) move(c, sample, options_.neighbour_rate);
    resource_[s] += increment_ * (density + error * squared_error);
    signals_[s] += signals_[s] < young ? 1 : 0;
    if (drift_ > 0.25 * mean_width_) refresh();
    return squared_error;
}

GrowingCells::Unit GrowingCells::insert() {
    const std::size_t n = options_.dimension;
    Unit q = CellComplex::none;
    for (Unit u = 0; u < complex_.unit_end(); ++u)
        if (complex_.has_unit(u) && (q == CellComplex::none || resource_[u] > resource_[q])) q = u;
    Unit f = CellComplex::none;
    double longest = -1;
    for (const Unit c : complex_.neighbours(q)) {
        const double length = distance_squared(c, position(q));
        if (length > longest) longest = length, f = c;
    }
    // The new unit takes resource from its neighbours in proportion to their loss of volume.
    std::vector<Unit> around(complex_.neighbours(q).begin(), complex_.neighbours(q).end());
    around.push_back(q);
    std::vector<double> before;
    for (const Unit c : around) before.push_back(volume(c));
    const Unit r = complex_.split_edge(q, f);
    for (std::size_t i = 0; i < n; ++i) position_.push_back(0.5 * (position_[q * n + i] + position_[f * n + i]));
    for (std::size_t b = 0; b < options_.outputs; ++b)
        output_.push_back(0.5 * (output_[q * options_.outputs + b] + output_[f * options_.outputs + b]));
    resource_.push_back(0), signals_.push_back(young), width_.push_back(0);
    width_[r] = options_.width_share * measured_width(r);
    tail_.push_back(r);
    const auto near = complex_.neighbours(r);
    for (std::size_t i = 0; i < around.size(); ++i) {
        const Unit c = around[i];
        if (!std::binary_search(near.begin(), near.end(), c)) continue;
        const double lost = std::clamp(1 - volume(c) / before[i], 0.0, 1.0);
        resource_[r] += lost * resource_[c];
        resource_[c] *= 1 - lost;
    }
    increment_ /= 1 - options_.decay;
    if (increment_ > max_increment) {
        for (double& v : resource_) v /= increment_;
        increment_ = 1;
    }
    if (tail_.size() > 8 + unit_count() / 8) refresh();
    return r;
}

std::size_t GrowingCells::remove_idle(double threshold, bool by_volume) {
    std::vector<Unit> old;
    std::vector<double> density;
    double mean = 0;
    for (const Unit u : units())
        if (signals_[u] < young) {
            old.push_back(u);
            density.push_back(signals_[u] / (by_volume ? volume(u) : 1));
            mean += density.back();
        }
    mean /= std::max<double>(1, static_cast<double>(old.size()));
    std::size_t gone = 0;
    for (std::size_t i = 0; i < old.size(); ++i)
        if (density[i] < threshold * mean && complex_.has_unit(old[i])) gone += complex_.remove(old[i]).size();
    std::fill(signals_.begin(), signals_.end(), 0u);
    if (gone > 0) refresh();
    return gone;
}

}  // namespace exitance
