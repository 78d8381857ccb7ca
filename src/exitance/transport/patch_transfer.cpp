#include "exitance/transport/patch_transfer.hpp"

#include <bit>

#include "exitance/base/parallel.hpp"
#include "exitance/base/trace.hpp"
#include "exitance/form_factors/hemisphere.hpp"
#include "exitance/form_factors/point_to_polygon.hpp"

namespace exitance {
namespace {

/// Multiplication by the third element of the field of four elements, whose addition is exclusive or.
constexpr unsigned twice[4] = {0, 2, 3, 1};

/// Orthogonal array OA(16, 4, 4, 2): a ray from cell (a, b) of one element leads to cell (a + b, a + 2 b) of the other,
/// in that field's arithmetic. Cells are numbered row by row. Adding a constant to the digits keeps the array
/// orthogonal.
constexpr std::array<unsigned, 16> partner_cell = [] {
    std::array<unsigned, 16> cell{};
    for (unsigned a = 0; a < 4; ++a)
        for (unsigned b = 0; b < 4; ++b) cell[4 * a + b] = 4 * (a ^ b) + (a ^ twice[b]);
    return cell;
}();

/// Moves point k to k ^ turn. The array is linear, so that this adds a constant to the digits of the destination cells.
RayEnds turned(const RayEnds& ends, unsigned turn) {
    RayEnds out;
    const unsigned within = turn & 3u;
    for (unsigned block = 0; block < RayEnds::size; block += 4) {
        const unsigned from = block ^ (turn & 12u);
        for (unsigned k = 0; k < 4; ++k) {
            out.x[block + k] = ends.x[from + (k ^ within)];
            out.y[block + k] = ends.y[from + (k ^ within)];
            out.z[block + k] = ends.z[from + (k ^ within)];
        }
    }
    return out;
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
    // If an ancestor is the patch of one leaf, it is the patch of every leaf below it; the highest such ancestor is
    // used.
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

void PatchTransfer::update_places() {
    const std::size_t first = centres_.size(), groups = samples_ / RayEnds::size;
    centres_.resize(tree_.size());
    receiving_.resize(tree_.size() * groups);
    sending_.resize(tree_.size() * groups);
    parallel_for(tree_.size() - first, 256, [&](std::size_t i) {
        const ElementId e(first + i);
        centres_[e.value] = tree_.patch(e).at(tree_.centre(e));
        RandomStream random(seed_, Stream::visibility, e.value);
        for (std::size_t g = 0; g < groups; ++g) {
            std::array<Point, RayEnds::size> places, partners;
            for (unsigned k = 0; k < RayEnds::size; ++k) {
                const double s = (k / 4 + random.uniform()) / 4, t = (k % 4 + random.uniform()) / 4;
                places[k] = tree_.patch(e).at(tree_.uniform(e, s, t));
            }
            for (unsigned k = 0; k < RayEnds::size; ++k) partners[k] = places[partner_cell[k]];
            receiving_[e.value * groups + g] = stage_.tracer.ray_ends(places, tree_.region(e));
            sending_[e.value * groups + g] = stage_.tracer.ray_ends(partners, tree_.region(e));
        }
    });
}

std::pair<RayEnds, RayEnds> PatchTransfer::rays(ElementId receiver, ElementId source, std::size_t group) const {
    const std::size_t groups = samples_ / RayEnds::size;
    const std::uint64_t turn = hash(seed_, receiver.value, source.value);
    const auto digits = static_cast<unsigned>(turn >> (4 * group % 64)) & 15u;
    return {receiving_[receiver.value * groups + group], turned(sending_[source.value * groups + group], digits)};
}

double PatchTransfer::visible_share(ElementId receiver, ElementId source, Workspace& w) const {
    if (joins_middles_) {
        bool hidden = false;
        w.rays += stage_.tracer.occluded({&centres_[receiver.value], 1}, {&centres_[source.value], 1},
                                         tree_.region(receiver), tree_.region(source), {&hidden, 1});
        return hidden ? 0 : 1;
    }
    unsigned blocked = 0;
    for (std::size_t group = 0; group < samples_ / RayEnds::size; ++group) {
        const auto [from, to] = rays(receiver, source, group);
        blocked += static_cast<unsigned>(std::popcount(stage_.tracer.occluded(from, to)));
    }
    w.rays += samples_;
    return 1 - static_cast<double>(blocked) / samples_;
}

/// True if the receiver's centre is in front of the source and the two belong to different regions.
bool PatchTransfer::faces(ElementId receiver, ElementId source) const {
    const RegionId other = tree_.region(source);
    return tree_.region(receiver) != other &&
           stage_.scene.regions()[other].plane.signed_distance(centres_[receiver.value]) > 0;
}

double PatchTransfer::form_factor_in_the_open(ElementId receiver, ElementId source) const {
    if (!faces(receiver, source)) return 0;
    const Normal& n = stage_.scene.regions()[tree_.region(receiver)].plane.n;
    return point_to_polygon(centres_[receiver.value], n, tree_.outline(source));
}

double PatchTransfer::form_factor(ElementId receiver, ElementId source, Workspace& w) const {
    const double F = form_factor_in_the_open(receiver, source);
    w.form_factors += F > 0;
    return F > 0 ? F * visible_share(receiver, source, w) : 0;
}

void PatchTransfer::column(std::span<const ElementId> receivers, ElementId source, std::span<float> out,
                           std::span<double> precise) const {
    const std::vector<Point> outline = tree_.outline(source);
    const std::array<Point, 4> quad = {outline[0], outline[1], outline[2], outline.back()};
    parallel_ranges(receivers.size(), 64,
                    [&](std::size_t begin, std::size_t end) {
                        Workspace w;
                        for (std::size_t i = begin; i < end; ++i) {
                            out[i] = 0;
                            if (!precise.empty()) precise[i] = 0;
                            if (!faces(receivers[i], source)) continue;
                            w.facing.push_back(i);
                            w.batch.add(centres_[receivers[i].value],
                                        stage_.scene.regions()[tree_.region(receivers[i])].plane.n);
                        }
                        w.F.resize(w.facing.size());
                        points_to_quad(w.batch, quad, w.F);
                        w.form_factors += w.facing.size();
                        for (std::size_t k = 0; k < w.facing.size(); ++k) {
                            const std::size_t i = w.facing[k];
                            const double F = precise.empty() ? 0 : form_factor_in_the_open(receivers[i], source);
                            if (!(w.F[k] > 0) && !(F > 0)) continue;
                            const double share = visible_share(receivers[i], source, w);
                            out[i] = static_cast<float>(w.F[k] * share);
                            if (!precise.empty()) precise[i] = F * share;
                        }
                        count(w);
                        note_source(tree_.region(source).value);
                    },
                    {"column", [&](std::size_t i) { return tree_.region(receivers[i]).value; }});
}

DenseTransport::DenseTransport(const PatchTransfer& transfer, const LeafNumbering& numbering, const PatchLevel& level,
                               Progress& progress, const StopRequest& stop)
    : level_(level), leaves_of_(level.patch_of, level.patches.size()) {
    const std::size_t columns = level.patches.size(), rows = numbering.leaves.size();
    F_.assign(rows * columns, 0.0f);
    std::vector<float> column(rows);
    for (std::size_t j = 0; j < columns && !stop.requested(); ++j) {
        transfer.column(numbering.leaves, level.patches[j], column);
        for (std::size_t i = 0; i < rows; ++i) F_[i * columns + j] = column[i];
        progress.advance(static_cast<double>(j + 1) / static_cast<double>(columns));
    }
}

Spectrum DenseTransport::gather_at(std::size_t receiver, std::span<const Spectrum> radiosity) const {
    const std::size_t columns = level_.patches.size();
    Spectrum sum;
    for (std::size_t p = 0; p < columns; ++p) {
        const double F = F_[receiver * columns + p];
        if (F == 0) continue;
        for (std::uint32_t leaf : leaves_of_[p]) sum += (F * level_.share[leaf]) * radiosity[leaf];
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
