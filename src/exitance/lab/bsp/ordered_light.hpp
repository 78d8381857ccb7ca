#pragma once

#include <optional>

#include "exitance/discontinuity/blocker_search.hpp"
#include "exitance/lab/bsp/minimum_lists.hpp"

namespace exitance {

/// Finds the visible sources and candidate blockers of regions and faces, like DirectLight::prepare but with the
/// structures of the thesis in place of shafts and a tree of boxes. The minimum lists of a scene BSP tree yield the
/// candidates. Penumbra volumes bounded by wedge planes select those that reach a face. Umbra volumes detect blockers
/// that hide all of a source; they are tested only if the bit masks show that no corner of the source sees the face. If
/// `merges_volumes`, the volumes of a source are merged into one tree per region (MergedVolumes): a face is then tested
/// against all of them at once, and several umbras that hide it only together are detected as well.
///
/// The sky, point and parallel lights, and the two sides of diffusing panes still use shafts. The resulting light is
/// equal to rounding. Source: [Gatenby95], [Chin89].
class OrderedLight : public BlockerSearch {
  public:
    /// `direct` must outlive this object. O(emitters x corners x fragments) memory.
    explicit OrderedLight(const DirectLight& direct, bool merges_volumes = false);

    ReceiverLight look(std::span<const Point> outline, RegionId region, DirectLight::Workspace& workspace,
                       Counts& counts) const override;
    /// Finds the light of the faces of one region. `whole`: the light of the region; `lights`: one for each face. Faces
    /// not processed before `stop` is requested stay dark.
    void look(const FaceOutlines& outlines, const ReceiverLight& whole, std::span<ReceiverLight> lights,
              const StopRequest& stop, DirectLight::Workspace& workspace, Counts& counts) const override;

    WedgeLists wedge_lists(std::uint32_t emitter, RegionId region) const override;

    std::size_t fragments() const override { return lists_->tree().fragments().size(); }

  private:
    struct Volume;
    struct SourceVolumes;
    std::vector<Volume> volumes_before(const DirectLight::SourceName& source, std::span<const Point> outline,
                                       RegionId region, bool& is_hidden, Counts& counts) const;
    SourceVolumes volumes_of(const ReceiverLight& whole, const ReceiverLight::Source& source, const Box& space) const;
    std::vector<SourceVolumes> volumes_of(const ReceiverLight& whole, const Box& space, ReceiverLight& others) const;
    bool hides(const SourceVolumes& volumes, std::span<const Point> face, const ReceiverLight& whole,
               const ReceiverLight::Source& source, std::vector<PieceId>& candidates, Counts& counts) const;
    bool is_listed(std::uint32_t emitter) const { return !direct_->is_distant(emitter); }
    bool face_each_other(std::span<const Point> receiver, const Normal& n, const DirectLight::SourceName& source) const;
    std::uint64_t corners_over(std::uint32_t emitter, std::span<const Point> receiver, const Normal& n) const;

    const DirectLight* direct_;
    bool merges_;
    std::vector<std::vector<Point>> corners_;  ///< Per emitter.
    std::optional<MinimumLists> lists_;
};

}  // namespace exitance
