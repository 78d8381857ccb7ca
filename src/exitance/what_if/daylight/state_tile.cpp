#include "exitance/what_if/daylight/state_tile.hpp"

namespace exitance {

StateTile::StateTile(const DaylightSetting& setting, const YearSuns& suns, std::span<const StateRows> parts,
                     TileRange tile, std::span<const float> sun, double bias)
    : setting_(setting), parts_(setting.states ? parts : std::span<const StateRows>()), tile_(tile) {
    if (parts_.empty()) return;
    EXI_CHECK(parts_.size() == setting.states->parts.size());
    find_straight(suns, sun);
    if (setting.states->variants.empty()) return;
    variants_.emplace(*setting.states, setting.criteria, bias, tile.count);
    variants_->add_sun(sun, sun_);
}

void StateTile::correct(std::span<float> lux, std::size_t replicate) {
    if (parts_.empty()) return;
    std::vector<std::vector<float>> light = straight_;
    for (std::size_t k = 0; k < parts_.size(); ++k) {
        const DaylightMatrix& part = parts_[k].matrix;
        setting_.sky.add_with_sun(
            rows_of(replicate < daylight_replicates ? part.replicates[replicate] : part.reflected), light[k]);
    }
    if (variants_) variants_->add(replicate, lux, light);
    for (std::size_t k = 0; k < parts_.size(); ++k) add_weighted(k, light[k], lux);
    remove_rounding(lux);
}

/// Finds the light of each part that reaches the sensors without a reflection, from the sun and from the sky.
void StateTile::find_straight(const YearSuns& suns, std::span<const float> sun) {
    const std::size_t hours = setting_.sky.hours(), m = parts_.front().matrix.patches;
    for (std::size_t k = 0; k < parts_.size(); ++k) {
        const StatePart& part = setting_.states->parts[k];
        const std::span<const float> direct = rows_of(parts_[k].matrix.direct);
        std::vector<float>& of_part = sun_.emplace_back(tile_.count * hours, 0.0f);
        if (!part.occluders) of_part.assign(sun.begin(), sun.end());
        for (std::size_t i = 0; i < tile_.count; ++i) {
            const SurfacePoint& at = parts_[k].places[tile_.first + i];
            const std::span<float> row = std::span(of_part).subspan(i * hours, hours);
            if (part.occluders) suns.find(*part.occluders, at, direct.subspan(i * m, m), row);
            suns.keep_through(*part.groups, part.group, at, row);
        }
        straight_.push_back(of_part);
        setting_.sky.add_sky(direct, straight_.back());
    }
}

void StateTile::add_weighted(std::size_t part, std::span<const float> light, std::span<float> out) const {
    const std::vector<float>& weights = setting_.states->parts[part].weights;
    const std::size_t hours = weights.size();
    for (std::size_t i = 0; i < tile_.count; ++i)
        for (std::size_t h = 0; h < hours; ++h) out[i * hours + h] += weights[h] * light[i * hours + h];
}

void StateTile::correct_sun(std::span<float> sun) const {
    for (std::size_t k = 0; k < parts_.size(); ++k) add_weighted(k, sun_[k], sun);
    if (!parts_.empty()) remove_rounding(sun);
}

std::vector<float> StateTile::uncertainty(std::span<const float> lux) const {
    if (parts_.empty()) return {};
    const std::vector<std::uint8_t>& is_changed = setting_.states->is_changed;
    const std::size_t hours = is_changed.size();
    std::vector<float> out(lux.begin(), lux.end());
    for (std::size_t k = 0; k < out.size(); ++k)
        out[k] *= is_changed[k % hours] != 0 ? static_cast<float>(setting_.states->twice) : 0.0f;
    return out;
}

}  // namespace exitance
