#pragma once

#include <array>
#include <atomic>
#include <memory>
#include <vector>

#include "exitance/mesh/pieces.hpp"
#include "exitance/transport/stage.hpp"

namespace exitance {

/// Transport of light from a source patch to the patch that owns the list.
struct Interaction {
    static constexpr float unknown = -1;
    std::uint32_t source = 0;
    float form_factor = unknown;  ///< F_pq of the receiver p without occlusion.
    float visible = unknown;      ///< Share of unoccluded rays between them.
};

/// A node of a quadtree over a piece, with its list of interactions.
struct TaskPatch {
    static constexpr std::uint32_t none = 0xffffffffu, being_made = 0xfffffffeu;

    Patch shape;
    Plane plane;
    RegionId region;
    double area = 0;              ///< m^2
    std::uint32_t polygon = 0;    ///< Index of the piece that contains the patch.
    std::uint32_t parent = none;  ///< Index of the parent; none for a piece.
    std::uint8_t level = 0, corner_count = 4;
    /// Two bits per level from the highest down. Identifies the patch independently of its id.
    std::uint64_t path = 0;
    std::array<Point, 4> corners;
    std::array<Point, 4> receiving;  ///< Points at which form factors are evaluated, as many as corners.
    RayEnds places;                  ///< Stratified end points of visibility rays.

    std::atomic<std::uint32_t> first_child{none};  ///< First of four consecutive children.
    std::vector<Interaction> list;
    Spectrum irradiance;  ///< Irradiance that the patch and its ancestors have gathered in this iteration, W/m^2.
    std::array<Spectrum, 2> radiosity{};  ///< After iterations of even and odd number, W/m^2.
    /// Number of children whose radiosity is not known yet in this iteration.
    std::atomic<std::uint32_t> open_children{0};
    std::uint32_t reached = 0;  ///< Last iteration in which a task processed it.

    std::span<const Point> outline() const { return std::span(corners).first(corner_count); }
};

/// Quadtrees over the pieces of a scene; any number of threads may split patches concurrently.
///
/// The contents of a patch depend only on its piece and path; the thread that first splits its parent creates it. Ids
/// depend on the order of creation and do not affect results, except that parents have smaller ids than their children.
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
    std::uint32_t root_count() const { return root_count_; }  ///< Roots have the first ids, in the order of the pieces.

    /// Returns the first of a patch's four children. Creates them if there are none, with their parent's radiosity in
    /// `slot`.
    std::uint32_t children(std::uint32_t parent, std::size_t slot);

    /// End points of the rays of a group between two patches. An orthogonal array pairs the points, shifted by a hash
    /// of the two patches.
    std::pair<RayEnds, RayEnds> rays(const TaskPatch& p, const TaskPatch& q, std::size_t group) const;
    /// Bit k: true if each end of ray k is in front of the other patch.
    std::uint32_t facing_rays(const TaskPatch& p, const TaskPatch& q, std::size_t group) const;

    std::size_t memory_bytes() const;
    static constexpr std::uint8_t deepest = 24;

  private:
    static constexpr std::uint32_t chunk = 1024;
    static constexpr std::size_t max_chunks = 1u << 16;
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
