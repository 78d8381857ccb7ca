#include "exitance/measure/pictures/camera.hpp"

#include <fmt/format.h>

#include <cmath>

namespace exitance {
namespace {

constexpr double max_fisheye_angle = 360;  // degrees, derived from the sphere of all directions
/// Degrees. Derived from the scale at the sides of the picture, which is 130 times that in the middle.
constexpr double max_perspective_angle = 170;

double pixel_width(const Camera& camera, PictureSize size) {
    switch (camera.projection) {
        case Projection::perspective:
            return 2 * std::tan(0.5 * camera.fov * degree) / size.width;
        case Projection::orthographic:
            return camera.fov / size.width;
        case Projection::fisheye:
            return camera.fov * degree / std::min(size.width, size.height);
        case Projection::panorama:
            break;
    }
    return 2 * pi / size.width;
}

}  // namespace

std::optional<std::string> find_fault(const Camera& c) {
    const Vec3 view = c.target - c.eye;
    if (!is_finite(c.eye) || !std::isfinite(norm(view)) || !std::isfinite(norm(c.up)) || !std::isfinite(c.fov))
        return "the numbers of a camera must be finite";
    if (!(norm(view) > 0)) return "the camera's eye and target must be different points";
    if (!(norm(c.up) > 0)) return "the camera's upward direction must not be zero";
    const bool is_above_zero = c.fov > 0 || c.projection == Projection::panorama;
    if (c.projection == Projection::orthographic && !is_above_zero)
        return fmt::format("the camera's width must be above 0 m, not {}", c.fov);
    const double most = c.projection == Projection::fisheye       ? max_fisheye_angle
                        : c.projection == Projection::perspective ? max_perspective_angle
                                                                  : HUGE_VAL;
    if (!is_above_zero || c.fov > most)
        return fmt::format("the camera's angle must be above 0 and at most {} degrees, not {}", most, c.fov);
    return std::nullopt;
}

CameraRays::CameraRays(const Camera& camera, PictureSize size)
    : projection_(camera.projection), size_(size), eye_(camera.eye), pixel_(pixel_width(camera, size)) {
    ahead_ = normalized(camera.target - camera.eye);
    Vec3 up = normalized(camera.up);
    if (projection_ == Projection::panorama) {  // in a panorama the middle row of pixels is the horizon
        const Vec3 level = ahead_ - dot(ahead_, up) * up;
        ahead_ = norm(level) > 1e-6 ? normalized(level) : Frame(up).u;
    }
    if (std::abs(dot(ahead_, up)) >= 0.9999) up = std::abs(ahead_.y) < 0.9 ? Vec3{0, 1, 0} : Vec3{0, 0, 1};
    right_ = normalized(cross(ahead_, up)), down_ = cross(ahead_, right_);
}

bool CameraRays::ray(double x, double y, Point& origin, Vec3& direction) const {
    const double s = pixel_ * (x - 0.5 * size_.width), t = pixel_ * (y - 0.5 * size_.height);
    origin = eye_;
    switch (projection_) {
        case Projection::perspective:
            direction = ahead_ + s * right_ + t * down_;
            return true;
        case Projection::orthographic:
            origin = eye_ + s * right_ + t * down_;
            direction = ahead_;
            return true;
        case Projection::fisheye: {
            const double angle = std::hypot(s, t), disc = 0.5 * pixel_ * std::min(size_.width, size_.height);
            const double across = angle > 0 ? std::sin(angle) / angle : 1;
            direction = std::cos(angle) * ahead_ + across * (s * right_ + t * down_);
            return angle <= disc;
        }
        case Projection::panorama: {
            const double below = pi * (y / size_.height - 0.5);  // angle below the horizon; pixels need not be square
            direction = std::cos(below) * (std::cos(s) * ahead_ + std::sin(s) * right_) + std::sin(below) * down_;
            return std::abs(below) <= 0.5 * pi;
        }
    }
    return false;
}

}  // namespace exitance
