#pragma once

#include <memory>
#include <mutex>

#include "exitance/base/progress.hpp"
#include "exitance/cli/view/view_server.hpp"
#include "exitance/cli/view/view_units.hpp"
#include "exitance/evaluate/radiosity_function.hpp"

namespace exitance {

/// Renders pictures for the viewer's page, one at a time. A new request stops the previous one, which is answered with
/// status 409.
class ViewFrames {
  public:
    explicit ViewFrames(ViewUnits units) : units_(units) {}

    /// Renders a picture. Parameters: `camera=ex,ey,ez,tx,ty,tz,fov` (metres, degrees), `size=WIDTH,HEIGHT` in pixels,
    /// `samples=N` rays per pixel. The answer is in the format of viewer_frame(). Safe from any thread.
    ViewAnswer take(const RadiosityFunction& light, const ViewServer::Parameters& parameters);

  private:
    ViewUnits units_;
    std::mutex newest_, working_;
    std::shared_ptr<StopRequest> stop_;  ///< Stop request of the newest picture.
};

}  // namespace exitance
