#include "exitance/transport/patch_transfer.hpp"

#include "exitance/core/parallel.hpp"
#include "exitance/transport/form_factor.hpp"
#include "exitance/transport/hemisphere.hpp"

namespace exitance {
namespace {

/// Products in the field of four elements.
constexpr std::uint8_t times[4][4] = {{0, 0, 0, 0}, {0, 1, 2, 3}, {0, 2, 3, 1}, {0, 3, 1, 2}};

/// Row `i` (0 to 15) of the orthogonal array OA(16, 4, 4, 2): four levels 0 to 3, every pair of columns holding every
/// pair of levels once. Addition in the field is exclusive or.
std::array<unsigned, 4> orthogonal_row(unsigned i) {
    const unsigned a = i / 4, b = i % 4;
    return {a, b, a ^ b, a ^ times[2][b]};
}

}  // namespace

PatchLevel::PatchLevel(const ElementTree& tree, const LeafNumbering& numbering, int levels)
    : patch_of(numbering.leaves.size()), share(numbering.leaves.size()) {
    Field<ElementId, std::uint32_t> index(tree.size(), 0xffffffffu);
    std::vector<ElementId> wanted(numbering.leaves.size());
    for (std::size_t i = 0; i < wanted.size(); ++i) {
        ElementId e = numbering.leaves[i];
        for (int k = 0; k < levels && !tree.parent(e).is_none(); ++k) e = tree.parent(e);
        wanted[i] = e;
        index[e] = 0;
    }
    // An ancestor that is wanted by one leaf is the patch of every leaf below it: the highest one counts.
    for (std::size_t i = 0; i < wanted.size(); ++i)
        for (ElementId e = wanted[i]; !tree.parent(e).is_none(); e = tree.parent(e))
            if (index[tree.parent(e)] == 0) wanted[i] = tree.parent(e);
    std::vector<ElementId> sorted = wanted;
    std::sort(sorted.begin(), sorted.end());
    sorted.erase(std::unique(sorted.begin(), sorted.end()), sorted.end());
    patches = std::move(sorted);
    for (std::size_t p = 0; p < patches.size(); ++p) index[patches[p]] = static_cast<std::uint32_t>(p);
    for (std::size_t i = 0; i < wanted.size(); ++i) {
        patch_of[i] = index[wanted[i]];
        share[i] = tree.area(numbering.leaves[i]) / tree.area(wanted[i]);
    }
}

std::vector<Spectrum> PatchLevel::pull(std::span<const Spectrum> leaf_values) const {
    std::vector<Spectrum> out(patches.size());
    for (std::size_t i = 0; i < leaf_values.size(); ++i) out[patch_of[i]] += share[i] * leaf_values[i];
    return out;
}

double PatchTransfer::visible_share(ElementId receiver, ElementId source, Workspace& w) const {
    const Patch &to = tree_.patch(receiver), &from = tree_.patch(source);
    RandomStream random(seed_, Stream::visibility, receiver.value, source.value);
    w.from.resize(samples_), w.to.resize(samples_);
    for (unsigned k = 0; k < samples_; ++k) {
        // Sixteen at a time: levels of the array, turned by a random digit in each column, with jitter inside the cell.
        const std::array<unsigned, 4> level = orthogonal_row(k % 16);
        std::array<double, 4> t;
        for (std::size_t c = 0; c < 4; ++c) t[c] = (static_cast<double>(level[c]) + random.uniform()) / 4;
        w.to[k] = to.at(tree_.uniform(receiver, t[0], t[1]));
        w.from[k] = from.at(tree_.uniform(source, t[2], t[3]));
    }
    w.rays += samples_;
    stage_.tracer.occluded(w.to, w.from, tree_.region(receiver), tree_.region(source), std::span(w.blocked).first(samples_));
    const auto blocked = std::count(w.blocked.begin(), w.blocked.begin() + samples_, true);
    return 1 - static_cast<double>(blocked) / samples_;
}

double PatchTransfer::form_factor(ElementId receiver, ElementId source, Workspace& w) const {
    if (tree_.region(receiver) == tree_.region(source)) return 0;
    const Plane& plane = stage_.scene.regions()[tree_.region(receiver)].plane;
    const Patch& from = tree_.patch(source);
    w.source.clear();
    for (const Vec2 corner : tree_.domain(source)) w.source.push_back(from.at(corner));
    ++w.form_factors;
    const double F = point_to_polygon(tree_.patch(receiver).at(tree_.centre(receiver)), plane.n, w.source);
    return F > 0 ? F * visible_share(receiver, source, w) : 0;
}

void PatchTransfer::column(std::span<const ElementId> receivers, ElementId source, std::span<float> out) const {
    parallel_ranges(receivers.size(), 64, [&](std::size_t begin, std::size_t end) {
        Workspace workspace;
        for (std::size_t i = begin; i < end; ++i)
            out[i] = static_cast<float>(form_factor(receivers[i], source, workspace));
        count(workspace);
    });
}

DenseTransport::DenseTransport(const PatchTransfer& transfer, const LeafNumbering& numbering, const PatchLevel& level,
                               Progress& progress, const StopRequest& stop)
    : level_(level), first_leaf_(level.patches.size() + 1, 0), leaves_(numbering.leaves.size()) {
    const std::size_t columns = level.patches.size(), rows = numbering.leaves.size();
    F_.assign(rows * columns, 0.0f);
    std::vector<float> column(rows);
    for (std::size_t j = 0; j < columns && !stop.requested(); ++j) {
        transfer.column(numbering.leaves, level.patches[j], column);
        for (std::size_t i = 0; i < rows; ++i) F_[i * columns + j] = column[i];
        progress.advance(static_cast<double>(j + 1) / static_cast<double>(columns));
    }
    for (std::uint32_t p : level.patch_of) ++first_leaf_[p + 1];
    for (std::size_t p = 0; p < columns; ++p) first_leaf_[p + 1] += first_leaf_[p];
    std::vector<std::uint32_t> next(first_leaf_.begin(), first_leaf_.end() - 1);
    for (std::size_t i = 0; i < rows; ++i) leaves_[next[level.patch_of[i]]++] = static_cast<std::uint32_t>(i);
}

Spectrum DenseTransport::gather_at(std::size_t receiver, std::span<const Spectrum> radiosity) const {
    const std::size_t columns = level_.patches.size();
    Spectrum sum;
    for (std::size_t p = 0; p < columns; ++p) {
        const double F = F_[receiver * columns + p];
        if (F == 0) continue;
        for (std::uint32_t k = first_leaf_[p]; k < first_leaf_[p + 1]; ++k)
            sum += (F * level_.share[leaves_[k]]) * radiosity[leaves_[k]];
    }
    return sum;
}

void DenseTransport::gather(std::span<const Spectrum> radiosity, std::span<Spectrum> irradiance) const {
    const std::size_t columns = level_.patches.size();
    const std::vector<Spectrum> patch = level_.pull(radiosity);
    parallel_for(size(), 16, [&](std::size_t i) {
        Spectrum sum;
        for (std::size_t p = 0; p < columns; ++p) sum += static_cast<double>(F_[i * columns + p]) * patch[p];
        irradiance[i] = sum;
    });
}

}  // namespace exitance
