#pragma once

#include <memory>
#include <mutex>

#include "exitance/base/progress.hpp"
#include "exitance/cli/view/view_server.hpp"
#include "exitance/evaluate/radiosity_function.hpp"

namespace exitance {

/// Pictures of the renderer for the viewer's page, one at a time: a request ends the one before it, whose camera is out
/// of date (409). `camera=ex,ey,ez,tx,ty,tz,fov`, `size=WIDTH,HEIGHT` in pixels, `samples=N` rays a pixel; the answer
/// is `viewer_frame`.
class ViewFrames {
  public:
    ViewAnswer take(const RadiosityFunction& light, const ViewServer::Parameters& parameters);

  private:
    std::mutex newest_, working_;
    std::shared_ptr<StopRequest> stop_;  ///< Of the newest request.
};

}  // namespace exitance
