#include "exitance/cli/view/view_frames.hpp"

#include "exitance/cli/view/view_words.hpp"
#include "exitance/io/export/viewer_frame.hpp"

namespace exitance {

ViewAnswer ViewFrames::take(const RadiosityFunction& light, const ViewServer::Parameters& parameters) {
    constexpr double max_side = 8192, max_pixels = 1 << 24, max_samples = 64;
    const auto numbers = view_numbers(parameters, "camera", 7), size = view_numbers(parameters, "size", 2),
               samples = view_numbers(parameters, "samples", 1);
    if (!numbers || !size || !samples) return view_misunderstood;
    const std::vector<double>& n = *numbers;
    const double width = (*size)[0], height = (*size)[1];
    PictureOptions options;
    options.camera = {{n[0], n[1], n[2]}, {n[3], n[4], n[5]}, n[6]};
    if (find_fault(options.camera) || !(width >= 1 && height >= 1) || width > max_side || height > max_side ||
        width * height > max_pixels || !((*samples)[0] >= 1) || (*samples)[0] > max_samples)
        return view_misunderstood;
    options.size = {static_cast<int>(width), static_cast<int>(height)};
    options.samples = static_cast<int>((*samples)[0]);
    const auto stop = std::make_shared<StopRequest>();
    {
        const std::lock_guard lock(newest_);
        if (stop_) stop_->interrupt();
        stop_ = stop;
    }
    const std::lock_guard lock(working_);
    Progress quiet;
    const ViewAnswer late{409, "text/plain", "a newer picture was requested"};
    if (stop->requested()) return late;
    const Picture picture = take_picture(light, options, quiet, *stop);
    if (stop->requested()) return late;
    return {200, "application/octet-stream", viewer_frame(picture, units_(light.solution().scene))};
}

}  // namespace exitance
