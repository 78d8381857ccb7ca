#pragma once

#include <array>
#include <functional>
#include <optional>
#include <vector>

#include "exitance/base/progress.hpp"
#include "exitance/evaluate/mesh_light.hpp"
#include "exitance/gather/gather.hpp"

namespace exitance {

constexpr int tile_side = 32;  ///< Pixels.

/// The part of one region that one pixel shows.
struct Spot {
    RegionId region;
    int x = 0, y = 0;                    ///< The pixel's position in its tile, from 0 to tile_side - 1.
    std::uint32_t pixel = 0;             ///< Number that selects the random numbers of the pixel's gather.
    std::uint32_t first = 0, count = 0;  ///< Range of the spot's points; the first four of them are well distributed.
    Spectrum irradiance = {};            ///< Mean over the points, W/m^2.
    Spectrum elements = {};              ///< The part of `irradiance` that is not exact direct light, W/m^2.
    /// Mean over the spot of the light of the solution's discontinuity mesh (MeshLight), if it was integrated. Points
    /// then give only the difference from that light, which has no shadow edges.
    std::optional<Spectrum> meshed = {};
};

/// Kind of points in the spots.
enum class SpotPoints : std::uint8_t {
    any,  ///< Arbitrary points.
    /// Spots are adjacent squares in a plane. In every whole square, points 0 and 1 are mirror images about the centre,
    /// and so are 2 and 3: if light is linear, the mean of either pair is that of the square.
    mirrored,
};

/// Computes light on the spots of a picture's tile, as described at take_picture. One per thread; keeps its memory.
class TileLight {
  public:
    /// `samples`: points per pixel; `gather`: rays per point, 0 for none. Keeps a reference to `light`.
    /// brightness  typical irradiance of the picture, W/m^2, which sets the noise allowed in dark pixels; 0: none
    TileLight(const RadiosityFunction& light, std::uint32_t samples, unsigned gather, std::uint64_t seed,
              SpotPoints kind = SpotPoints::any, double brightness = 0);

    /// Sets the mesh whose means spots may have; it must outlive the object.
    void use(const MeshLight& mesh) { mesh_ = &mesh; }
    /// Shows this irradiance in place of the solution's; it must outlive the object.
    void show(const std::function<Spectrum(RegionId, const Point&)>& shown) {
        shown_ = &shown, direct_share_ = Spectrum();
    }
    /// Adds all direct light to that of the elements, even if these hold a share of it, so that the parts of the light
    /// can be shown separately.
    void add_all_direct() { direct_share_ = Spectrum(1); }
    /// Interpolates light without shadow edges between pixels if the light at the centre of a cell of pixels differs
    /// from it by at most this share; 0: never.
    void interpolate_below(double difference) { interpolation_ = difference; }
    /// Sets a stop request, which must outlive the object: after a stop, evaluate() returns at once with unfinished
    /// spots.
    void use(const StopRequest& stop) { stop_ = &stop; }

    /// Sets the irradiance of every spot and reorders the spots. `points`: uncovered points on the spots' regions,
    /// metres.
    void evaluate(std::span<const Point> points, std::vector<Spot>& spots);

    static constexpr double alike = 0.01;  ///< Relative difference below which values are considered equal.

  private:
    static constexpr int block_side = 8, blocks = (tile_side / block_side) * (tile_side / block_side);
    static int block_of(const Spot& spot) {
        return spot.y / block_side * (tile_side / block_side) + spot.x / block_side;
    }

    static std::size_t pixel_of(const Spot& spot) { return static_cast<std::size_t>(spot.y * tile_side + spot.x); }
    /// Calls visit(block, first spot, last spot + 1) for all blocks of one region.
    template <class Visit>
    void visit_blocks(std::span<const Spot> spots, const Visit& visit) const {
        for (std::size_t begin = 0, end = 0; begin < spots.size(); begin = end) {
            const int block = block_of(spots[begin]);
            while (end < spots.size() && block_of(spots[end]) == block) ++end;
            visit(static_cast<std::size_t>(block), begin, end);
        }
    }

    /// The prepared direct light of a block, split by whether emitters may be blocked.
    struct SplitLight {
        bool is_split = false;
        ReceiverLight open;      ///< Emitters that are fully visible from the whole block: smooth.
        ReceiverLight shadowed;  ///< Emitters and lights that something may block.
    };
    /// Light at the centres of pixels, as far as it is known.
    struct PixelLight {
        std::array<Spectrum, tile_side * tile_side> light;  ///< W/m^2
        std::array<double, tile_side * tile_side> noise;    ///< Standard deviation of `light`, W/m^2.
        std::array<std::uint8_t, tile_side * tile_side> is_known{}, is_interpolated{};

        const Spectrum& set(std::size_t pixel, const Spectrum& found, double deviation) {
            is_known[pixel] = 1, is_interpolated[pixel] = 0, noise[pixel] = deviation;
            return light[pixel] = found;
        }
    };
    /// Rules by which light is interpolated in a cell of pixels, relative to the light of the cell.
    struct CellRule {
        double even;                ///< Difference of the corners below which light is interpolated.
        double middle;              ///< Allowed difference between the light at the centre and the interpolated light.
        bool checks_edges = false;  ///< Compare at the middles of the edges, too.
    };

    bool is_stopped() const { return stop_ && stop_->requested(); }
    void evaluate_region(std::span<Spot> spots);
    const ReceiverLight* look_at_block(std::span<const Spot> spots, const ReceiverLight* whole, ReceiverLight& room);
    bool outline(std::span<const Spot> spots);
    bool prepare(std::span<const Spot> spots, const ReceiverLight& whole, ReceiverLight& out);
    bool rays_are_cheaper(std::span<const Spot> spots, const ReceiverLight*& whole);
    Spectrum direct(const Spot& spot, const ReceiverLight* known, const Point& x);
    bool first_guess(Spot& spot, const ReceiverLight* known, Spectrum& light);
    Spectrum elements(const Spot& spot);
    bool looks_small(const Spot& spot, const ReceiverLight& known, const Point& middle) const;
    void evaluate_by_rays(std::span<Spot> spots);
    const Spot* spot_at(std::span<const Spot> spots, int x, int y) const;
    Point centre_of(const Spot& spot) const;
    LightAccuracy accuracy(double rest) const;
    Spectrum light_by_rays(const Spot& spot);
    Spectrum light_of_samples(const Spot& spot);
    void fill_all(std::span<Spot> spots);
    /// A cell of pixels, corners included, in pixels of the tile.
    struct Cell {
        int x0, y0, x1, y1;
    };
    template <class LightAt>
    void fill(std::span<Spot> spots, const Cell& cell, const CellRule& rule, PixelLight& out, const LightAt& light_at);
    template <class LightAt>
    bool interpolate(std::span<Spot> spots, const Cell& cell, const CellRule& rule, PixelLight& out,
                     const LightAt& light_at);
    void split_block(std::size_t block);
    void fill_open(std::span<Spot> spots, std::size_t block);
    void fill_shadowed(std::span<Spot> spots);
    Spectrum open_light(const Spot& spot, std::size_t block);
    Spectrum shadowed_light(const Spot& spot);
    bool differs_from_neighbours(std::span<const Spot> spots, std::size_t i) const;
    bool bends_between_neighbours(std::span<const Spot> spots, std::size_t i) const;
    Spectrum mirrored_mean(const Spot& spot, const Spectrum& rest, const ReceiverLight* known);

    const RadiosityFunction& light_;
    const MeshLight* mesh_ = nullptr;
    const StopRequest* stop_ = nullptr;
    const std::function<Spectrum(RegionId, const Point&)>* shown_ = nullptr;
    std::uint32_t samples_;
    unsigned gather_;
    std::uint64_t seed_;
    SpotPoints kind_;
    double brightness_;  ///< W/m^2
    double interpolation_ = 0;
    Spectrum direct_share_;  ///< Factor of exact direct light.
    std::span<const Point> points_;
    std::vector<Point> outline_;
    ReceiverLight whole_;
    std::array<ReceiverLight, blocks> parts_;
    std::array<const ReceiverLight*, blocks> known_;  ///< Prepared light of each block; null if none could be prepared.
    std::array<SplitLight, blocks> split_;
    /// For each pixel of the current region, the spot's index plus one; 0: none.
    std::array<std::uint32_t, tile_side * tile_side> spot_at_;
    std::vector<std::uint8_t> settled_;
    std::vector<Spectrum> rest_;  ///< All light except exact direct light, for every spot.
    /// Direct light by rays; for blocks with exact light, the light of their unoccluded emitters.
    PixelLight by_pixel_;
    PixelLight shadowed_;  ///< Direct light of partly occluded emitters, where it is interpolated.
    DirectLight::Workspace visibility_;
    PlaceLight::Workspace place_;
    GatherWorkspace gathering_;
};

}  // namespace exitance
