#pragma once

#include <deque>
#include <future>
#include <memory>
#include <mutex>

#include "exitance/evaluate/radiosity_function.hpp"
#include "exitance/measure/pictures/automatic_camera.hpp"

namespace exitance {

/// A solution that the page shows, with its camera and its radiosity function. The function, which points, lines and
/// exact pictures need, is built in the background while the page fetches the first elements.
class Viewed {
  public:
    explicit Viewed(Solution found)
        : solution(std::move(found)),
          light_(begun()),
          camera(automatic_camera(solution, RayTracer(solution.scene), Projection::perspective, {})) {}
    /// Shows a solution with the given camera, that of the previous solution.
    Viewed(Solution found, const Camera& as_before) : solution(std::move(found)), light_(begun()), camera(as_before) {}
    Viewed(const Viewed&) = delete;
    Viewed& operator=(const Viewed&) = delete;

    const RadiosityFunction& light() const { return *light_.get(); }

    const Solution solution;

  private:
    std::shared_future<std::unique_ptr<const RadiosityFunction>> begun() const {
        return std::async(std::launch::async, [this] { return std::make_unique<const RadiosityFunction>(solution); });
    }
    std::shared_future<std::unique_ptr<const RadiosityFunction>> light_;

  public:
    const Camera camera;
};

/// All solutions so far, the newest last. Older ones are kept because running requests may use them.
class Gallery {
  public:
    std::size_t add(Solution solution) {
        auto fresh = std::make_unique<Viewed>(std::move(solution));
        const std::lock_guard lock(mutex_);
        all_.push_back(std::move(fresh));
        return all_.size();
    }
    const Viewed* newest() const {
        const std::lock_guard lock(mutex_);
        return all_.empty() ? nullptr : all_.back().get();
    }

    /// The second of two solutions that are compared; null if there is one only.
    const Viewed* other() const { return other_.get(); }
    void set_other(Solution solution) { other_ = std::make_unique<Viewed>(std::move(solution), newest()->camera); }

  private:
    mutable std::mutex mutex_;
    std::deque<std::unique_ptr<Viewed>> all_;
    std::unique_ptr<Viewed> other_;
};

}  // namespace exitance
