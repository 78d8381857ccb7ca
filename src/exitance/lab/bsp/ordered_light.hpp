#pragma once

#include <optional>

#include "exitance/discontinuity/blocker_search.hpp"
#include "exitance/lab/bsp/minimum_lists.hpp"

namespace exitance {

/// What shines on regions and faces, as DirectLight::prepare finds it by shafts and a tree of boxes, by the thesis's
/// structures instead: candidates come from the minimum lists of a scene BSP tree; of these, penumbra volumes of wedge
/// planes keep what reaches a face, and umbra volumes tell what hides all of a source, asked only where bit masks leave
/// no corner of the source that sees the face. Source: [Gatenby95], [Chin89]. The same light to rounding.
/// Or, with faces, the volumes of a source are merged into one tree for each region that it lights (MergedVolumes):
/// faces are then asked about all at once, and those that several umbrae hide together are found, too.
///
/// The sky, lights without extent and the two sides of diffusing panes are looked at by shafts all the same.
class OrderedLight : public BlockerSearch {
  public:
    /// It must outlive this. O(emitters x corners x fragments) memory.
    explicit OrderedLight(const DirectLight& direct, bool merges_volumes = false);

    ReceiverLight look(std::span<const Point> outline, RegionId region, DirectLight::Workspace& workspace,
                       Counts& counts) const override;
    /// Faces of one region, of which `whole` tells what shines on all of it.
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
    std::vector<std::vector<Point>> corners_;  ///< Of emitters.
    std::optional<MinimumLists> lists_;
};

}  // namespace exitance
