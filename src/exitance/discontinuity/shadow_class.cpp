#include "exitance/discontinuity/shadow_class.hpp"

#include <algorithm>

namespace exitance {
namespace {

/// Views of sources from one point, added up.
class Sight {
  public:
    Sight(const DirectLight& direct, const ReceiverLight& light, const Point& x, DirectLight::Workspace& workspace)
        : direct_(direct), light_(light), at_(direct.receiver(x, light.n, light.own)), workspace_(workspace) {}

    /// Adds the sources that the light lists. Returns how many of them the point faces.
    std::size_t add_listed() {
        std::size_t faced = 0;
        for (const ReceiverLight::Source& s : light_.sources) {
            if (is_penumbra()) return faced;
            if (!faces({s.emitter, s.piece})) continue;
            ++faced;
            s.count == 0 ? add(1) : add(visible_share(s));
        }
        for (const Beam& b : light_.beams) {
            if (is_penumbra()) return faced;
            if (!faces_beam(b.light)) continue;
            ++faced;
            add(max(beam_light(b)) > 0 ? 1 : 0);
        }
        return faced;
    }
    /// Adds a share of a source, 0 to 1.
    void add(double visible_share) {
        sees_some_ |= visible_share > touching_share;
        sees_all_ &= visible_share > 1 - touching_share;
    }
    /// Adds all that another sight has seen.
    void add(const Sight& other) { sees_some_ |= other.sees_some_, sees_all_ &= other.sees_all_; }
    bool is_penumbra() const { return sees_some_ && !sees_all_; }
    ShadowClass shadow_class() const {
        return !sees_some_ ? ShadowClass::umbra : sees_all_ ? ShadowClass::lit : ShadowClass::penumbra;
    }

    /// True if part of a source's piece is in front of the point's plane, and the point is in front of the source.
    bool faces(const DirectLight::SourceName& source) const {
        const DirectLight::Emitter& e = direct_.emitters()[source.emitter];
        if (!direct_.shines_on(e, light_.own) || e.plane.signed_distance(at_.x) <= 0) return false;
        const auto corners = direct_.occluders().corners(source.piece);
        return std::any_of(corners.begin(), corners.end(),
                           [&](const Point& c) { return dot(light_.n, c - at_.x) > direct_.occluders().rounding(); });
    }
    /// True if light of a punctual light arrives at the point unless it is blocked.
    bool faces_beam(std::uint32_t light) const { return max(beam_light({light, 0, 0})) > 0; }

  private:
    double visible_share(const ReceiverLight::Source& s) {
        const Occluders& occluders = direct_.occluders();
        const double whole = visible_form_factor(occluders, at_, s.piece, {}, workspace_);
        const auto between = std::span(light_.candidates).subspan(s.first, s.count);
        return whole > 0 ? visible_form_factor(occluders, at_, s.piece, between, workspace_) / whole : 1;
    }
    Spectrum beam_light(const Beam& beam) const {
        return direct_.beams().irradiance(at_, std::span(&beam, 1), light_.candidates);
    }

    const DirectLight& direct_;
    const ReceiverLight& light_;
    SurfacePoint at_;
    DirectLight::Workspace& workspace_;
    bool sees_some_ = false, sees_all_ = true;
};

/// Number of all sources that a point faces.
std::size_t count_faced(const DirectLight& direct, const Sight& sight) {
    std::size_t out = 0;
    for (std::uint32_t e = 0; e < direct.emitters().size(); ++e)
        for (const PieceId p : direct.emitters()[e].pieces) out += sight.faces({e, p});
    if (direct.beams().empty()) return out;
    for (std::uint32_t l = 0; l < direct.scene().lights().size(); ++l) out += sight.faces_beam(l);
    return out;
}

}  // namespace

ShadowClass shadow_class_at(const DirectLight& direct, const ReceiverLight& light, const Point& x,
                            std::span<const DirectLight::SourceName> among, DirectLight::Workspace& workspace) {
    if (light.is_dark()) return ShadowClass::umbra;
    Sight sight(direct, light, x, workspace);
    const std::size_t listed = sight.add_listed();
    const auto faced = std::count_if(among.begin(), among.end(), [&](const auto& s) { return sight.faces(s); });
    if (static_cast<std::size_t>(faced) > listed) sight.add(0);
    return sight.shadow_class();
}

ShadowClass shadow_class_at(const DirectLight& direct, const ReceiverLight& light, const Point& x,
                            DirectLight::Workspace& workspace) {
    if (light.is_dark()) return ShadowClass::umbra;
    Sight sight(direct, light, x, workspace);
    const std::size_t listed = sight.add_listed();
    if (count_faced(direct, sight) > listed) sight.add(0);
    if (light.behind.empty()) return sight.shadow_class();
    Sight behind(direct, light.behind[0], x, workspace);
    const std::size_t listed_behind = behind.add_listed();
    if (count_faced(direct, behind) > listed_behind) behind.add(0);
    return sight.add(behind), sight.shadow_class();
}

}  // namespace exitance
