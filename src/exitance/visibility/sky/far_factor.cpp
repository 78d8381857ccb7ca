#include "exitance/visibility/sky/far_factor.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <tuple>
#include <vector>

#include "exitance/base/random.hpp"

namespace exitance {
namespace {

auto values_of(const SkyModel& sky) {
    static_assert(sizeof(SkyModel) == 16 * sizeof(double), "a member that is new belongs into this list");
    return std::tie(sky.a, sky.b, sky.g, sky.f0, sky.c, sky.d, sky.e, sky.sun, sky.intermediate, sky.ground,
                    sky.blends_ground, sky.below, sky.scale, sky.picture);
}

/// The sky models of a scene and the placement of the sky's parts, for exact comparison.
struct SkyParts {
    std::vector<SkyModel> models;
    Point middle;
    double size = 0;

    bool are_of(const Occluders& occluders) const {
        const auto& domes = occluders.scene().distant().domes;
        return size == occluders.scene().size() && middle == occluders.middle() &&
               std::equal(
                   models.begin(), models.end(), domes.begin(), domes.end(),
                   [](const SkyModel& own, const auto& dome) { return values_of(own) == values_of(dome.model); });
    }
    void set(const Occluders& occluders) {
        models.clear();
        for (const auto& dome : occluders.scene().distant().domes) models.push_back(dome.model);
        middle = occluders.middle(), size = occluders.scene().size();
    }
};

/// Form factors of all parts of the sky, per direction.
class FarFactorMemory {
  public:
    double& at(const Occluders& occluders, PieceId part, const Normal& n) {
        const IdRange<PieceId> parts = occluders.distant_pieces();
        if (!sky_.are_of(occluders)) {
            for (Slot& slot : slots_) slot.factors.clear();
            sky_.set(occluders);
        }
        Slot& slot = slots_[hash(std::bit_cast<std::uint64_t>(n.x), std::bit_cast<std::uint64_t>(n.y),
                                 std::bit_cast<std::uint64_t>(n.z)) %
                            slots_.size()];
        if (slot.factors.size() != parts.size() || !(slot.n == n)) {
            slot.n = n;
            slot.factors.assign(parts.size(), -1);
        }
        return slot.factors[part.value - parts.front().value];
    }

  private:
    struct Slot {
        Normal n;
        std::vector<double> factors;
    };
    SkyParts sky_;
    std::array<Slot, 64> slots_;
};

}  // namespace

double& known_far_factor(const Occluders& occluders, PieceId part, const Normal& n) {
    thread_local FarFactorMemory memory;
    return memory.at(occluders, part, n);
}

}  // namespace exitance
