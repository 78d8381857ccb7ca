#pragma once

#include <array>
#include <optional>
#include <vector>

#include "exitance/base/progress.hpp"
#include "exitance/direct/shared_rays.hpp"
#include "exitance/evaluate/mesh_light.hpp"
#include "exitance/gather/gather.hpp"

namespace exitance {

constexpr int tile_side = 32;  ///< Pixels.

/// What one pixel shows of one region.
struct Spot {
    RegionId region;
    int x = 0, y = 0;                    ///< The pixel's place in its tile, from 0 to tile_side - 1.
    std::uint32_t pixel = 0;             ///< Names the random numbers of its gather.
    std::uint32_t first = 0, count = 0;  ///< Of the points seen, in an order in which the first four are well spread.
    Spectrum irradiance = {};            ///< Mean over the points, W/m^2.
    /// Where the solution's mesh is integrated over the spot: the mean of its MeshLight. Points then count
    /// what the mesh is off by there, which has no edges.
    std::optional<Spectrum> meshed = {};
};

/// Whose points the spots are.
enum class SpotPoints : std::uint8_t {
    any,
    /// Squares side by side in a plane, and in every whole one the points 0 and 1 are mirror images in its middle, and
    /// so are 2 and 3: where light is linear, the mean of either pair is that of the square.
    mirrored,
};

/// Light on the spots of a picture's tile, as take_picture describes it. One a thread; keeps its memory.
class TileLight {
  public:
    /// `samples` points a pixel; `gather` rays a point, 0 for none. Keeps a reference to `light`.
    /// brightness  irradiance that is usual in the picture, W/m^2: how much noise is worth in dark pixels; 0: none
    TileLight(const RadiosityFunction& light, std::uint32_t samples, unsigned gather, std::uint64_t seed,
              SpotPoints kind = SpotPoints::any, double brightness = 0);

    /// The mesh whose means spots may have; it must outlive this.
    void use(const MeshLight& mesh) { mesh_ = &mesh; }
    /// A request to stop, which must outlive this: once it is made, evaluate() returns at once with unfinished spots.
    void use(const StopRequest& stop) { stop_ = &stop; }

    /// Fills in the irradiance of every spot and brings the spots into an order of its own. `points` are places in the
    /// open on the spots' regions, metres.
    void evaluate(std::span<const Point> points, std::vector<Spot>& spots);

    static constexpr double alike = 0.01;  ///< Values that differ by less make no difference to their mean.

  private:
    static constexpr int block_side = 8, blocks = (tile_side / block_side) * (tile_side / block_side);
    static int block_of(const Spot& spot) {
        return spot.y / block_side * (tile_side / block_side) + spot.x / block_side;
    }

    static std::size_t pixel_of(const Spot& spot) { return static_cast<std::size_t>(spot.y * tile_side + spot.x); }
    /// Calls visit(block, its first spot, past its last one) for all blocks of one region.
    template <class Visit>
    void visit_blocks(std::span<const Spot> spots, const Visit& visit) const {
        for (std::size_t begin = 0, end = 0; begin < spots.size(); begin = end) {
            const int block = block_of(spots[begin]);
            while (end < spots.size() && block_of(spots[end]) == block) ++end;
            visit(static_cast<std::size_t>(block), begin, end);
        }
    }

    bool is_stopped() const { return stop_ && stop_->requested(); }
    void evaluate_region(std::span<Spot> spots);
    const ReceiverLight* look_at_block(std::span<const Spot> spots, const ReceiverLight* whole, ReceiverLight& room);
    bool prepare(std::span<const Spot> spots, const ReceiverLight* whole, ReceiverLight& out);
    Spectrum direct(const Spot& spot, const ReceiverLight* known, const Point& x);
    bool first_guess(Spot& spot, const ReceiverLight* known, Spectrum& light);
    Spectrum elements(const Spot& spot);
    bool looks_small(const Spot& spot, const ReceiverLight& known, const Point& middle) const;
    bool suits_clusters(std::span<const Spot> spots);
    bool share_rays(std::span<const Spot> spots, const ReceiverLight* whole);
    void evaluate_by_clusters(std::span<Spot> spots);
    void evaluate_by_shared_rays(std::span<Spot> spots);
    const Spot* spot_at(std::span<const Spot> spots, int x, int y) const;
    LightAccuracy accuracy(double rest) const;
    Spectrum light_by_rays(const Spot& spot);
    void fill_all(std::span<Spot> spots);
    void fill(std::span<Spot> spots, int x0, int y0, int x1, int y1);
    bool interpolate(std::span<Spot> spots, int x0, int y0, int x1, int y1);
    bool differs_from_neighbours(std::span<const Spot> spots, std::size_t i) const;
    bool bends_between_neighbours(std::span<const Spot> spots, std::size_t i) const;
    Spectrum mirrored_mean(const Spot& spot, const Spectrum& rest, const ReceiverLight* known);

    const RadiosityFunction& light_;
    const MeshLight* mesh_ = nullptr;
    const StopRequest* stop_ = nullptr;
    std::uint32_t samples_;
    unsigned gather_;
    std::uint64_t seed_;
    SpotPoints kind_;
    double brightness_;      ///< W/m^2
    Spectrum direct_share_;  ///< Of exact direct light, on top of the rest.
    std::span<const Point> points_;
    std::vector<Point> outline_;
    ReceiverLight whole_;
    std::array<ReceiverLight, blocks> parts_;
    std::array<const ReceiverLight*, blocks> known_;            ///< Null where nothing could be prepared.
    SharedRays shared_;                                         ///< Of the region at hand,
    std::array<SharedRays::Part, blocks> shared_parts_;         ///< and of its blocks,
    std::array<bool, blocks> by_rays_;                          ///< where these are left to rays.
    std::array<std::uint32_t, tile_side * tile_side> spot_at_;  ///< Of the region at hand: one past the spot's number.
    std::vector<std::uint8_t> settled_;
    std::vector<Spectrum> rest_;                                ///< Of every spot: all but exact direct light.
    std::array<Spectrum, tile_side * tile_side> found_;         ///< By rays: direct light of a pixel
    std::array<double, tile_side * tile_side> noise_;           ///< (standard deviation, W/m^2)
    std::array<std::uint8_t, tile_side * tile_side> is_found_;  ///< that is known.
    DirectLight::Workspace visibility_;
    ClusteredLight::Workspace clustered_;
    GatherWorkspace gathering_;
};

}  // namespace exitance
