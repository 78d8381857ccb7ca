#include "exitance/view_factors/row_caster.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "exitance/base/random.hpp"
#include "exitance/form_factors/hemisphere.hpp"

namespace exitance {

RowCaster::RowCaster(const RowScene& scene, const StopRequest& stop)
    : scene_(scene),
      stop_(stop),
      of_batch_(scene.faces.size()),
      hits_(scene.faces.size()),
      squares_(scene.faces.size()) {
    for (auto& column : coordinates_) column.resize(block);
    for (auto& column : sorted_) column.resize(block);
    origins_.reserve(block), directions_.reserve(block), found_.resize(block);
}

double RowCaster::variance(const Count& count) const {
    const double k = static_cast<double>(batches_), m = static_cast<double>(rays_a_batch_);
    const double spread = count.squares - count.hits * count.hits / k;
    return std::max(0.0, spread) / (k * (k - 1) * m * m);
}

/// Traces the rays in origins_ and directions_ and counts the faces that they hit.
void RowCaster::trace(std::size_t face, bool under_others) {
    const RegionId own = scene_.region(face);
    if (under_others) {  // rays that start below another face hit it at once, so remove them
        std::size_t kept = 0;
        for (std::size_t k = 0; k < origins_.size(); ++k)
            if (!scene_.is_hidden(origins_[k], face))
                origins_[kept] = origins_[k], directions_[kept++] = directions_[k];
        back_in_batch_ += static_cast<std::uint32_t>(origins_.size() - kept);
        origins_.resize(kept), directions_.resize(kept);
        if (kept == 0) return;
    }
    const std::span<RayHit> hits(found_.data(), origins_.size());
    scene_.tracer.nearest(origins_, directions_, own, hits);
    for (std::size_t k = 0; k < hits.size(); ++k) {
        const RayHit& hit = hits[k];
        if (hit.surface.is_none()) {
            ++sky_in_batch_;
            continue;
        }
        if (!hit.front || hit.surface.value == face || scene_.ends_hidden(hit, origins_[k], directions_[k])) {
            ++back_in_batch_;
            continue;
        }
        if (of_batch_[hit.surface.value]++ == 0) met_in_batch_.push_back(hit.surface.value);
    }
}

/// Orders the points of a block by cells of their directions, so that the rays of a packet are traced together. The
/// points are stratified, hence each cell of a square grid has as many as a packet.
void RowCaster::sort_by_direction(std::size_t count) {
    const auto cells = static_cast<std::size_t>(std::sqrt(static_cast<double>(count / rays_a_packet)));
    const auto cell_of = [&](std::size_t k) {
        const auto place = [&](double x) { return static_cast<std::size_t>(x * static_cast<double>(cells)); };
        const std::size_t row = place(coordinates_[2][k]), column = place(coordinates_[3][k]);
        // in a zigzag, so that consecutive cells are neighbours
        return row * cells + (row % 2 == 0 ? column : cells - 1 - column);
    };
    std::array<std::uint16_t, block / rays_a_packet + 1> starts{};
    for (std::size_t k = 0; k < count; ++k) ++starts[cell_of(k) + 1];
    for (std::size_t c = 1; c < starts.size(); ++c) starts[c] = static_cast<std::uint16_t>(starts[c] + starts[c - 1]);
    order_.resize(count);
    for (std::size_t k = 0; k < count; ++k) order_[starts[cell_of(k)]++] = static_cast<std::uint16_t>(k);
}

void RowCaster::cast_batch(std::size_t face, bool under_others, std::uint64_t seed) {
    const ScrambledSobol points(seed);
    const FaceSampler& sampler = scene_.samplers[face];
    const Frame frame(sampler.normal());
    for (std::size_t first = 0; first < rays_a_batch_ && !stop_.requested(); first += block) {
        const std::size_t count = std::min(block, rays_a_batch_ - first);
        for (int d = 0; d < 4; ++d)
            points.fill(static_cast<std::uint32_t>(first), d, std::span(coordinates_[d]).first(count));
        origins_.clear(), directions_.clear();
        sort_by_direction(count);
        for (std::size_t i = 0; i < count; ++i) {
            const std::uint16_t k = order_[i];
            origins_.push_back(sampler(coordinates_[0][k], coordinates_[1][k]));
            sorted_[0][i] = coordinates_[2][k], sorted_[1][i] = coordinates_[3][k];
        }
        directions_.resize(count);
        cosine_directions(frame, std::span(sorted_[0]).first(count), std::span(sorted_[1]).first(count), directions_);
        trace(face, under_others);
    }
}

void RowCaster::finish_batch() {
    for (std::uint32_t column : met_in_batch_) {
        const double hits = std::exchange(of_batch_[column], 0);
        if (hits_[column] == 0) met_.push_back(column);
        hits_[column] += hits, squares_[column] += hits * hits;
    }
    met_in_batch_.clear();
    const double sky = std::exchange(sky_in_batch_, 0), back = std::exchange(back_in_batch_, 0);
    sky_.hits += sky, sky_.squares += sky * sky;
    back_.hits += back, back_.squares += back * back;
    missed_.hits += sky + back, missed_.squares += (sky + back) * (sky + back);
}

void RowCaster::cast(std::size_t face, std::size_t batches, std::size_t rays_a_batch, bool under_others,
                     std::uint64_t seed) {
    batches_ = batches, rays_a_batch_ = rays_a_batch;
    counts_.clear(), sky_ = back_ = missed_ = {};
    for (std::size_t b = 0; b < batches && !stop_.requested(); ++b) {
        cast_batch(face, under_others, hash(seed, b));
        finish_batch();
    }
    std::sort(met_.begin(), met_.end());
    for (std::uint32_t column : met_)
        counts_.push_back({column, std::exchange(hits_[column], 0), std::exchange(squares_[column], 0)});
    met_.clear();
}

}  // namespace exitance
