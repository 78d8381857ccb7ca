#pragma once

#include <optional>
#include <string>
#include <vector>

#include "exitance/scene/scene.hpp"
#include "exitance/visibility/glass/pane_groups.hpp"

namespace exitance {

/// A state of a group of panes, such as "open" or "blinds down".
struct PaneState {
    std::string name;
    /// Factor on the light that has crossed panes of the group, from 0 to 1. The panes mirror as much as before.
    double factor = 1;
    std::optional<std::size_t> scene;  ///< Index of the scene with the geometry of this state; none: no other geometry.
};

/// Choice of the state of a group in every hour.
struct StateRule {
    enum class Kind : std::uint8_t {
        schedule,     ///< A table has the state of every hour.
        illuminance,  ///< The mean illuminance at sensors decides, in the first state of all groups.
        sunlight,     ///< LM-83: the last state if more than 2% of a grid have at least 1000 lx of direct sun.
    };
    Kind kind = Kind::schedule;
    std::vector<std::uint8_t> schedule;  ///< State of every hour.
    std::vector<std::size_t> sensors;    ///< Sensors of the rule `illuminance`.
    /// Limits of `illuminance`, lx, ascending: in state k, k of them are exceeded. One fewer than states.
    std::vector<double> limits;
};

/// Panes with common states. The first state is that of the scene.
struct PaneGroup {
    std::string name;
    std::vector<PaneState> states;
    StateRule rule;
    /// True for states of shades, which change all light of the scene and not only that of panes. Such a group is the
    /// only one.
    bool has_all_light = false;
};

/// The scene with additional geometry, for one state of one group.
struct StateScene {
    Scene scene;
    std::size_t group = 0;
    /// Per pane: 0 if it belongs to this group, else PaneGroups::no_group. Not used if the group has all light.
    std::vector<std::int32_t> group_of_pane;
};

/// Other glass: factors on the light that has crossed panes of each group, in all states of it.
struct GlassVariant {
    std::string name;
    std::vector<double> factors;  ///< Factor of each group, from 0 to 1.
};

/// Groups of panes whose states change from hour to hour.
struct DaylightStates {
    std::vector<PaneGroup> groups;
    std::vector<std::int32_t> group_of_pane;  ///< Per pane: the number of its group, as in PaneGroups.
    std::vector<StateScene> scenes;
    bool has_all_panes = false;               ///< True if every pane of the scene belongs to a group.
    std::vector<GlassVariant> variants = {};  ///< Variants of glass for which further results are computed.
};

/// Light through the panes of a group in the geometry of a scene, and the multiple of it that is added to the light of
/// the scene in every hour.
struct StatePart {
    const PaneGroups* groups = nullptr;
    std::size_t group = 0;                 ///< Number of the group in `groups`.
    const Occluders* occluders = nullptr;  ///< Occluders of a scene with more geometry; null for the scene itself.
    std::vector<float> weights = {};       ///< Factor for every hour.
};

/// Weights of the parts if other glass is installed, in the occupied hours.
struct VariantWeights {
    std::vector<std::vector<float>> parts;  ///< Weight of each part in every occupied hour, as in StatePart.
    std::vector<float> uncertainty;         ///< Light that may be wrong in every occupied hour, relative to all light.
    std::vector<double> factors;            ///< Factor of the transmission of every group.
};

/// The states of all groups in every hour, as corrections of the light in their first states:
///
///     E(h) = E_1(h) + sum_g (f_g(h) E_g,s(h) - E_g,1(h)),
///
/// E_g,s being the light that has crossed panes of group g in the geometry of its state s, f its factor. This is exact
/// but for light that crosses panes of groups twice.
struct HourlyStates {
    std::vector<std::vector<std::uint8_t>> state;  ///< Per group and hour: number of the state.
    std::vector<StatePart> parts;
    std::vector<std::uint8_t> is_changed;  ///< Per hour: 1 if some group is not in its first state.
    double twice = 0;                      ///< Light that crosses panes twice, relative to all light.
    std::vector<std::size_t> occupied;     ///< Indices of the occupied hours; only with variants.
    std::vector<VariantWeights> variants;
};

}  // namespace exitance
