#pragma once

#include <array>
#include <atomic>
#include <memory>
#include <vector>

#include "exitance/mesh/pieces.hpp"
#include "exitance/transport/stage.hpp"

namespace exitance {

/// Light from one patch to the patch whose list this stands in.
struct Interaction {
    static constexpr float unknown = -1;
    std::uint32_t source = 0;
    float form_factor = unknown;  ///< F_pq of the receiver p in the open.
    float visible = unknown;      ///< Share of the rays between them that pass.
};

/// A node of a quadtree over a piece, with its list of interactions.
struct TaskPatch {
    static constexpr std::uint32_t none = 0xffffffffu, being_made = 0xfffffffeu;

    Patch shape;
    Plane plane;
    RegionId region;
    double area = 0;              ///< m^2
    std::uint32_t polygon = 0;    ///< The piece below which it lies.
    std::uint32_t parent = none;  ///< None for a piece.
    std::uint8_t level = 0, corner_count = 4;
    std::uint64_t path = 0;  ///< Two bits a level, from the highest down: its name, whoever made it when.
    std::array<Point, 4> corners;
    std::array<Point, 4> receiving;  ///< Where form factors to it are taken, as many as corners.
    RayEnds places;                  ///< Stratified, where rays begin and end.

    std::atomic<std::uint32_t> first_child{none};  ///< Of four side by side.
    std::vector<Interaction> list;
    Spectrum irradiance;                  ///< What it and the patches above it have gathered in an iteration, W/m^2.
    std::array<Spectrum, 2> radiosity{};  ///< After iterations of even and odd number, W/m^2.
    std::atomic<std::uint32_t> open_children{0};  ///< Whose radiosity is not known yet, in this iteration.
    std::uint32_t reached = 0;                    ///< The last iteration whose tasks came to it.

    std::span<const Point> outline() const { return std::span(corners).first(corner_count); }
};

/// Quadtrees over the pieces of a scene, which any number of threads may cut at once.
///
/// What a patch is follows from its piece and its path alone; who cuts its parent first makes it. Ids tell when it was
/// made and are no part of any result, but for parents' being smaller than their children's.
class PatchPool {
  public:
    PatchPool(const Stage& stage, std::uint64_t seed);
    ~PatchPool();
    PatchPool(const PatchPool&) = delete;
    PatchPool& operator=(const PatchPool&) = delete;

    TaskPatch& operator[](std::uint32_t id) { return chunks_[id / chunk].load(std::memory_order_acquire)[id % chunk]; }
    const TaskPatch& operator[](std::uint32_t id) const {
        return chunks_[id / chunk].load(std::memory_order_acquire)[id % chunk];
    }
    std::uint32_t size() const { return size_.load(std::memory_order_acquire); }
    std::uint32_t root_count() const { return root_count_; }  ///< These come first, in the order of the pieces.

    /// The first of a patch's four children, which are made where there are none: with the radiosity of their parent
    /// in `slot`.
    std::uint32_t children(std::uint32_t parent, std::size_t slot);

    /// Two patches' rays: places are paired by an orthogonal array, turned by what the patches are.
    std::pair<RayEnds, RayEnds> rays(const TaskPatch& p, const TaskPatch& q, std::size_t group) const;
    /// Bit k: do both ends of ray k lie in front of the other patch?
    std::uint32_t facing_rays(const TaskPatch& p, const TaskPatch& q, std::size_t group) const;

    std::size_t memory_bytes() const;
    static constexpr std::uint8_t deepest = 24;

  private:
    static constexpr std::uint32_t chunk = 1024;
    static constexpr std::size_t most_chunks = 1u << 16;
    std::uint32_t allocate(std::uint32_t count);
    void set_up(TaskPatch& patch, RegionId region, const Patch& shape);
    unsigned turn(const TaskPatch& p, const TaskPatch& q, std::size_t group) const;
    std::array<Point, RayEnds::size> places(const TaskPatch& patch) const;

    const Stage& stage_;
    std::uint64_t seed_;
    std::uint32_t root_count_ = 0;
    std::atomic<std::uint32_t> size_{0};
    std::unique_ptr<std::atomic<TaskPatch*>[]> chunks_;
};

}  // namespace exitance
