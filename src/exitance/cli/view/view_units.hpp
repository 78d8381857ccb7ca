#pragma once

#include "exitance/cli/options/arguments.hpp"
#include "exitance/scene/scene.hpp"

namespace exitance {

/// Unit in which the viewer's page shows the light of scenes.
class ViewUnits {
  public:
    explicit ViewUnits(const UnitArguments& arguments) : arguments_(arguments) {}

    LightUnit operator()(const Scene& scene) const {
        return {arguments_.choice, scene.is_photometric(), arguments_.efficacy.value_or(daylight_efficacy)};
    }

  private:
    UnitArguments arguments_;
};

}  // namespace exitance
