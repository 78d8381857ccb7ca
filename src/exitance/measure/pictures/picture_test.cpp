#include "exitance/measure/pictures/picture.hpp"

#include <gtest/gtest.h>

#include "exitance/base/parallel.hpp"
#include "exitance/measure/pictures/automatic_camera.hpp"
#include "exitance/measure/pictures/timed_picture.hpp"
#include "exitance/transport/stage.hpp"
#include "support/built_scene.hpp"
#include "support/sample_solution.hpp"
#include "support/solved.hpp"

namespace exitance {
namespace {

/// Solution of a furnace, E = M / (1 - rho), all of it in the elements.
Solution furnace(double rho) {
    Solution s = even_solution(box_scene(1, 2, 1, rho, 1, 1), 1 / (1 - rho), 20);
    s.direct_in_elements = true;
    return s;
}

Picture picture_of(const Solution& s, const Camera& camera, PictureSize size, int samples = 4, unsigned gather = 0) {
    Progress progress;
    const StopRequest stop;
    return take_picture(RadiosityFunction(s), {camera, size, samples, gather, 1}, progress, stop);
}

Vec3 direction(const CameraRays& rays, double x, double y) {
    Point origin;
    Vec3 along;
    EXPECT_TRUE(rays.ray(x, y, origin, along));
    return normalized(along);
}

TEST(Camera, AFaultIsFoundIfPicturesCannotBeMade) {
    const Camera good{{0, 0, 0}, {0, 0, -1}, 60, {0, 0, 1}, Projection::perspective};
    EXPECT_FALSE(find_fault(good)) << "the line of sight may be vertical";
    const auto with = [&](auto change) {
        Camera camera = good;
        change(camera);
        return find_fault(camera).value_or("");
    };
    EXPECT_NE(with([](Camera& c) { c.target = c.eye; }).find("different points"), std::string::npos);
    EXPECT_NE(with([](Camera& c) { c.target.x = NAN; }).find("finite"), std::string::npos);
    EXPECT_NE(with([](Camera& c) { c.eye.x = -1e308, c.target.x = 1e308; }).find("finite"), std::string::npos);
    EXPECT_NE(with([](Camera& c) { c.fov = NAN; }).find("finite"), std::string::npos);
    EXPECT_NE(with([](Camera& c) { c.up = {}; }).find("upward"), std::string::npos);
    for (const double fov : {0.0, -1.0, 180.0})
        EXPECT_NE(with([&](Camera& c) { c.fov = fov; }).find("at most 170 degrees"), std::string::npos) << fov;
    EXPECT_NE(with([](Camera& c) { c.fov = 0, c.projection = Projection::orthographic; }).find("width"),
              std::string::npos);
    EXPECT_EQ(with([](Camera& c) { c.fov = 360, c.projection = Projection::fisheye; }), "");
    EXPECT_EQ(with([](Camera& c) { c.fov = 0, c.projection = Projection::panorama; }), "");
}

TEST(CameraRays, TheCentreIsTheTargetAndTheEdgesAreHalfTheAngleAway) {
    const Camera camera{{1, 2, 3}, {4, 6, 3}, 90};
    const CameraRays rays(camera, {200, 100});
    const Vec3 ahead = direction(rays, 100, 50), right = direction(rays, 200, 50);
    EXPECT_NEAR(norm(ahead - Vec3{0.6, 0.8, 0}), 0, 1e-14);
    EXPECT_NEAR(dot(ahead, right), std::sqrt(0.5), 1e-14);
    EXPECT_GT(dot(right, Vec3{0.8, -0.6, 0}), 0);                       // (4, -3) is to the right of (3, 4)
    EXPECT_GT(direction(rays, 100, 0).z, direction(rays, 100, 100).z);  // the first row is at the top
    EXPECT_TRUE(is_finite(direction(CameraRays({{0, 0, 1}, {0, 0, 0}}, {2, 2}), 0, 0)));
}

TEST(CameraRays, AreParallelForAnOrthographicCamera) {
    const Camera camera{{0, 0, 5}, {0, 0, 0}, 4, {0, 1, 0}, Projection::orthographic};
    const CameraRays rays(camera, {200, 100});
    Point left, right, top;
    Vec3 along, other;
    ASSERT_TRUE(rays.ray(0, 50, left, along));
    ASSERT_TRUE(rays.ray(200, 50, right, other));
    ASSERT_TRUE(rays.ray(100, 0, top, other));
    EXPECT_EQ(along, other);
    EXPECT_NEAR(norm(right - left - Vec3{4, 0, 0}), 0, 1e-14);
    EXPECT_NEAR(norm(top - Point{0, 1, 5}), 0, 1e-14);  // up is at the top
}

TEST(CameraRays, HaveAnglesProportionalToTheirPositionInAFisheye) {
    const Camera camera{{0, 0, 0}, {0, 1, 0}, 240, {0, 0, 1}, Projection::fisheye};
    const CameraRays rays(camera, {200, 100});  // the disc is 100 pixels wide
    for (const double share : {0.0, 0.3, 0.9})
        EXPECT_NEAR(std::acos(direction(rays, 100, 50 - 50 * share).y), share * 120 * pi / 180, 1e-12);
    EXPECT_NEAR(direction(rays, 100 + 50 * 0.75, 50).x, 1, 1e-12);  // 90 degrees to the right
    Point origin;
    Vec3 along;
    EXPECT_FALSE(rays.ray(40, 50, origin, along));
}

TEST(CameraRays, CoverAllDirectionsInAPanoramaWithTheTargetInTheMiddle) {
    const Camera camera{{0, 0, 0}, {0, 2, 1}, 60, {0, 0, 1}, Projection::panorama};
    const CameraRays rays(camera, {400, 200});
    EXPECT_NEAR(norm(direction(rays, 200, 100) - Vec3{0, 1, 0}), 0, 1e-14);  // the horizon is in the middle
    EXPECT_NEAR(norm(direction(rays, 300, 100) - Vec3{1, 0, 0}), 0, 1e-14);
    EXPECT_NEAR(norm(direction(rays, 0, 100) - Vec3{0, -1, 0}), 0, 1e-14);
    EXPECT_NEAR(norm(direction(rays, 37, 0) - Vec3{0, 0, 1}), 0, 1e-14);
}

TEST(Picture, IsUniformInAFurnace) {
    const double rho = 0.6, expected = 1 / (1 - rho);
    const Picture picture = picture_of(furnace(rho), {{0.2, 0.3, 0.5}, {0.9, 1.9, 0.4}, 90}, {24, 16});
    ASSERT_EQ(picture.pixels.size(), 24u * 16u);
    for (const Pixel& pixel : picture.pixels) {
        EXPECT_EQ(pixel.front, 1);
        EXPECT_NEAR(pixel.radiosity[0], expected, 1e-6);  // elements store floats
        EXPECT_NEAR(pixel.irradiance[0], expected, 1e-6);
    }
}

TEST(Picture, ShowsAnotherIrradianceOnRequest) {
    const Solution s = furnace(0.6);
    const RadiosityFunction light(s);
    const PictureOptions options{{{0.2, 0.3, 0.5}, {0.9, 1.9, 0.4}, 90}, {40, 30}, 1};
    Progress progress;
    const StopRequest stop;
    const ShownIrradiance shown = [](RegionId, const Point& x) { return Spectrum(1 + x.y); };
    const Picture picture = take_picture_of(shown, light, options, progress, stop);
    const CameraRays rays(options.camera, options.size);
    for (int y = 0; y < 30; ++y)
        for (int x = 0; x < 40; ++x) {
            Point origin;
            Vec3 along;
            ASSERT_TRUE(rays.ray(x + 0.5, y + 0.5, origin, along));
            RayHit hit;
            light.stage().tracer.nearest(std::span(&along, 1), origin, RegionId(), std::span(&hit, 1));
            const Pixel& pixel = picture.pixels[static_cast<std::size_t>(y * 40 + x)];
            const double E = 1 + (origin + hit.distance * along).y;
            EXPECT_NEAR(pixel.irradiance[0], E, 1e-5);           // rays are cast in single precision
            EXPECT_NEAR(pixel.radiosity[0], 1 + 0.6 * E, 1e-5);  // every surface emits 1 W/m^2
        }
    const TimedPicture timed = take_picture_in_time(light, options, progress, stop, shown);
    ASSERT_TRUE(timed.is_complete);
    for (std::size_t i = 0; i < picture.pixels.size(); ++i)
        EXPECT_EQ(timed.picture.pixels[i].irradiance, picture.pixels[i].irradiance);
}

TEST(Picture, ShowsNoLightOnBacksAndInEmptySpace) {
    const Solution s = furnace(0.5);
    const Picture picture = picture_of(s, {{0.5, -3, 0.5}, {0.5, 0, 0.5}, 90}, {21, 21});
    const Pixel& middle = picture.pixels[10 * 21 + 10];
    EXPECT_EQ(middle.back, 1);
    EXPECT_EQ(middle.radiosity, Spectrum());
    EXPECT_EQ(picture.pixels.front().back + picture.pixels.front().front, 0);
}

/// Light at the hit of the ray through a pixel's centre, as `probe` evaluates it.
Light light_behind(const Solution& s, const RadiosityFunction& light, const CameraRays& rays, int x, int y) {
    Point origin;
    Vec3 along;
    EXPECT_TRUE(rays.ray(x + 0.5, y + 0.5, origin, along));
    RayHit hit;
    light.stage().tracer.nearest(std::span(&along, 1), origin, RegionId(), std::span(&hit, 1));
    const ProbePoint there{origin + hit.distance * along, s.scene.surfaces()[hit.surface].normal};
    return light.at(std::span(&there, 1))[0];
}

TEST(Picture, ShowsTheFunctionInEveryPixel) {
    const Solution s = sample_solution();
    const Camera camera{{1.9, 0.9, 0.9}, {0.2, 0.2, 0}, 80};
    const PictureSize size{48, 32};
    const Picture picture = picture_of(s, camera, size, 1);
    const RadiosityFunction light(s);
    const CameraRays rays(camera, size);
    for (int y = 0; y < size.height; ++y)
        for (int x = 0; x < size.width; ++x) {
            const Pixel& pixel = picture.pixels[static_cast<std::size_t>(y * size.width + x)];
            if (pixel.front == 0) continue;
            const Light expected = light_behind(s, light, rays, x, y);
            // Shadows are cut by the shaft's candidates instead of the tree's: equal up to rounding.
            for (std::size_t b = 0; b < bands; ++b)
                EXPECT_NEAR(pixel.irradiance[b], expected.irradiance[b], 1e-9 * (1 + expected.irradiance[b]));
        }
}

TEST(Picture, IsTheMeanOverThePixelForManySamples) {
    const Solution s = sample_solution();
    const Camera camera{{1.9, 0.9, 0.9}, {0.2, 0.2, 0}, 30};
    const Picture sixteen = picture_of(s, camera, {12, 8}, 16), many = picture_of(s, camera, {12, 8}, 1024);
    double difference = 0, level = 0;
    for (std::size_t i = 0; i < sixteen.pixels.size(); ++i) {
        difference += std::abs(mean(sixteen.pixels[i].radiosity) - mean(many.pixels[i].radiosity));
        level += mean(many.pixels[i].radiosity);
    }
    EXPECT_LT(difference, 0.05 * level);  // the elements of a sample jump at every border, by random amounts
}

TEST(Picture, AFinalGatherOfAFurnaceIsUniformToo) {
    const double rho = 0.5;
    Solution s = furnace(rho);
    s.direct_in_elements = true;  // a gather includes the direct light
    const Picture picture = picture_of(s, {{0.2, 0.3, 0.5}, {0.9, 1.9, 0.4}, 90}, {6, 4}, 2, 4);
    for (const Pixel& pixel : picture.pixels)  // E_dir = M exactly, E_ind = rho E for any rays
        EXPECT_NEAR(pixel.irradiance[0], 1 / (1 - rho), 1e-6);
}

/// Solution of a scene without reflection: all light is direct.
Solution unreflected_light(Scene scene) {
    Solution s;
    s.scene = std::move(scene);
    ElementFunction& f = s.interpolant;
    f.tree = Stage(s.scene).make_elements({.edge = 10});
    f.first_value.resize(f.tree.size(), 0);
    for (ElementId e : f.tree.leaves()) {
        f.first_value[e] = static_cast<std::uint32_t>(f.values.size());
        for (int k = 0; k < f.tree.patch(e).corner_count(); ++k) f.values.emplace_back();
    }
    s.indirect = f;
    return s;
}

/// Two furnished rooms with 96 lamps, without reflection.
Solution many_shadows() {
    return unreflected_light(built_scene("carpet", {{"u", "12"}, {"v", "8"}, {"cuts", "1"}, {"books", "0"}}));
}

TEST(Picture, InterpolatesLightWithoutVisibleDifference) {
    const Solution s =
        unreflected_light(built_scene("office", {{"nx", "1"}, {"ny", "1"}, {"nfurn", "1"}, {"books", "0"}}));
    const Camera camera{{3.5, 3.5, 1.6}, {1, 1, 0.6}, 80};
    const RadiosityFunction light(s, DirectBy::closed_forms);
    Progress progress;
    const StopRequest stop;
    PictureOptions options{camera, {192, 128}, 2};
    const Picture exact = take_picture(light, options, progress, stop);
    options.interpolation = 0.003;
    const Picture fast = take_picture(light, options, progress, stop);
    std::size_t changed = 0, visible = 0;
    for (std::size_t i = 0; i < exact.pixels.size(); ++i) {
        const double expected = mean(exact.pixels[i].irradiance), found = mean(fast.pixels[i].irradiance);
        EXPECT_NEAR(found, expected, 0.1 * expected + 1e-3) << i;
        changed += found != expected, visible += std::abs(found - expected) > 0.02 * expected;
    }
    EXPECT_GT(changed, exact.pixels.size() / 10);    // light is interpolated
    EXPECT_LT(visible, exact.pixels.size() / 1000);  // differences are large only in shadow edges
}

TEST(Picture, ShowsTheFunctionUpToNoiseWithManyShadows) {
    const Solution s = many_shadows();
    const Camera camera{{6, 3, 1.5}, {4, 2, 0.8}, 80};
    const PictureSize size{96, 64};
    const Picture picture = picture_of(s, camera, size, 1);
    const RadiosityFunction light(s, DirectBy::closed_forms);
    const CameraRays rays(camera, size);
    double all = 0, miss = 0, count = 0;
    for (int y = 0; y < size.height; y += 3)
        for (int x = 0; x < size.width; x += 3) {
            const Pixel& pixel = picture.pixels[static_cast<std::size_t>(y * size.width + x)];
            if (pixel.front == 0) continue;
            const double expected = mean(light_behind(s, light, rays, x, y).irradiance);
            const double E = mean(pixel.irradiance);
            all += expected, miss += std::pow((E - expected) / std::max(expected, 0.01), 2), ++count;
        }
    EXPECT_GT(all / count, 0.1);  // W/m^2
    // The required accuracy is 0.4%, and light is interpolated if its centre agrees within 1%; some pixels use all
    // rays.
    EXPECT_LT(std::sqrt(miss / count), 0.02);
}

TEST(Picture, AStopLeavesItEmpty) {
    const Solution s = sample_solution();
    Progress progress;
    StopRequest stop;
    stop.interrupt();
    const RadiosityFunction light(s);
    const Picture picture = take_picture(light, {{{1.9, 0.9, 0.9}, {0, 0, 0}}, {8, 8}}, progress, stop);
    EXPECT_EQ(picture.pixels[0].front, 0);
}

TEST(Picture, HasTheSameBitsOnAnyNumberOfThreads) {
    const Solution s = sample_solution();
    const Camera camera{{1.9, 0.9, 0.9}, {0, 0, 0}, 80};
    set_threads(1);
    const Picture one = picture_of(s, camera, {31, 17});
    set_threads(2);
    const Picture two = picture_of(s, camera, {31, 17});
    set_threads(0);
    for (std::size_t i = 0; i < one.pixels.size(); ++i) {
        EXPECT_EQ(one.pixels[i].radiosity, two.pixels[i].radiosity);
        EXPECT_EQ(one.pixels[i].front, two.pixels[i].front);
    }
}

TEST(AutomaticCamera, IsInsideAClosedRoomAndOutsideAnOpenScene) {
    const PictureSize size{64, 40};
    const auto is_inside = [&](const Solution& s) {
        const Point eye = automatic_camera(s, RayTracer(s.scene), Projection::perspective, size).eye;
        const Box& box = s.scene.box();
        return min(eye, box.lo) == box.lo && max(eye, box.hi) == box.hi;
    };
    EXPECT_TRUE(is_inside(sample_solution()));
    SceneDescription plate;
    plate.points = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}};
    plate.materials = {{"grey", Spectrum(0.5), Spectrum(1)}};
    plate.groups = {"plate"};
    plate.faces = {{{0, 1, 2, 3}, 0, 0, 1}};
    const CheckedScene made = make_scene(plate);
    ASSERT_TRUE(static_cast<bool>(made.scene));
    Solution open;
    open.scene = *made.scene;
    open.indirect = open.interpolant = sample_function(open.scene, 1, 3);
    EXPECT_FALSE(is_inside(open));
}

TEST(AutomaticCamera, LooksIntoARoomThroughItsOpenSide) {
    SceneDescription d;
    for (const double z : {0.0, 1.0}) d.points.insert(d.points.end(), {{0, 0, z}, {1, 0, z}, {1, 1, z}, {0, 1, z}});
    d.materials = {{"wall", Spectrum(0.5), Spectrum()}, {"ceiling", Spectrum(0.5), Spectrum(1)}};
    d.groups = {"box"};  // box without the wall at y = 0
    const std::vector<std::vector<std::uint32_t>> faces = {
        {0, 1, 2, 3}, {4, 7, 6, 5}, {1, 5, 6, 2}, {2, 6, 7, 3}, {3, 7, 4, 0}};
    for (std::size_t i = 0; i < faces.size(); ++i) d.faces.push_back({faces[i], i == 1 ? 1u : 0u, 0, 1});
    Solution s;
    s.scene = *make_scene(d).scene;
    s.indirect = s.interpolant = sample_function(s.scene, 1, 40);
    const Camera camera = automatic_camera(s, RayTracer(s.scene), Projection::perspective, {64, 64});
    EXPECT_LT(camera.eye.y, 0);
    EXPECT_NEAR(camera.eye.x, 0.5, 1e-12);
    EXPECT_GT(camera.target.y, camera.eye.y);
}

/// Faces of a box of one material; fronts inwards or outwards.
void add_box(SceneDescription& d, const Point& lo, const Point& hi, std::uint32_t material, bool inwards) {
    const auto first = static_cast<std::uint32_t>(d.points.size());
    for (const double z : {lo.z, hi.z})
        d.points.insert(d.points.end(), {{lo.x, lo.y, z}, {hi.x, lo.y, z}, {hi.x, hi.y, z}, {lo.x, hi.y, z}});
    for (std::vector<std::uint32_t> face : box_faces) {
        for (std::uint32_t& corner : face) corner += first;
        if (!inwards) std::reverse(face.begin(), face.end());
        d.faces.push_back({face, material, 0, 1});
    }
}

TEST(AutomaticCamera, StandsInASmallRoomInTheLightAndNotInFurnitureOrWalls) {
    // A lavatory of 0.9 x 1.3 m with a cistern cupboard, in a block with a dark store room that is larger.
    SceneDescription d;
    d.materials = {{"wall", Spectrum(0.7), Spectrum()}, {"lamp", Spectrum(0.0), Spectrum(100)}};
    d.groups = {"all"};
    const Point lo{0, 0, 0}, hi{0.9, 1.3, 2.2}, cupboard_lo{0.1, 0.9, 0.01}, cupboard_hi{0.8, 1.29, 1.1};
    add_box(d, lo, hi, 0, true);
    add_box(d, cupboard_lo, cupboard_hi, 0, false);
    add_box(d, {1.1, 0, 0}, {4, 3, 2.2}, 0, true);
    add_box(d, {-0.2, -0.2, -0.2}, {4.2, 3.2, 2.4}, 0, false);
    d.points.insert(d.points.end(), {{0.3, 0.4, 2.19}, {0.3, 0.7, 2.19}, {0.6, 0.7, 2.19}, {0.6, 0.4, 2.19}});
    const auto n = static_cast<std::uint32_t>(d.points.size());
    d.faces.push_back({{n - 4, n - 3, n - 2, n - 1}, 1, 0, 1});
    for (const double scale : {1.0, 0.1}) {
        SceneDescription scaled = d;
        for (Point& p : scaled.points) p = scale * p;
        const Solution s = solved(*make_scene(scaled).scene, {.error = 0.1});
        const Point eye = (1 / scale) * automatic_camera(s, RayTracer(s.scene), Projection::perspective, {64, 40}).eye;
        const auto is_within = [&](const Point& a, const Point& b) {
            return eye.x > a.x && eye.y > a.y && eye.z > a.z && eye.x < b.x && eye.y < b.y && eye.z < b.z;
        };
        EXPECT_TRUE(is_within(lo, hi)) << eye.x << " " << eye.y << " " << eye.z;
        EXPECT_FALSE(is_within(cupboard_lo, cupboard_hi));
    }
}

/// Requests a stop when the given pass begins, counted from 1.
class StopAtPass : public Progress {
  public:
    StopAtPass(StopRequest& stop, int pass) : stop_(stop), pass_(pass) {}
    void advance(double fraction, std::string_view) override {
        if (fraction == 0 && --pass_ == 0) stop_.interrupt();
    }

  private:
    StopRequest& stop_;
    int pass_;
};

TimedPicture stopped_picture(const Solution& s, const PictureOptions& options, int pass) {
    StopRequest stop;
    StopAtPass progress(stop, pass);
    return take_picture_in_time(RadiosityFunction(s), options, progress, stop);
}

void expect_same_light(const Picture& a, const Picture& b) {
    ASSERT_EQ(a.pixels.size(), b.pixels.size());
    for (std::size_t i = 0; i < a.pixels.size(); ++i) {
        ASSERT_EQ(a.pixels[i].radiosity, b.pixels[i].radiosity) << "pixel " << i;
        ASSERT_EQ(a.pixels[i].irradiance, b.pixels[i].irradiance) << "pixel " << i;
        ASSERT_EQ(a.pixels[i].front, b.pixels[i].front) << "pixel " << i;
    }
}

TEST(TakePictureInTime, HasTheBitsOfTakePictureIfTimeSuffices) {
    const Solution s = sample_solution();
    const Camera camera{{0.1, 0.1, 0.5}, {1.5, 0.5, 0.5}, 70};
    const PictureOptions options{camera, {150, 90}, 5};
    const Picture whole = picture_of(s, camera, {150, 90}, 5);
    for (const double seconds : {0.0, 1e6}) {
        StopRequest stop;
        if (seconds > 0) stop.set_deadline(StopRequest::Clock::now() + std::chrono::seconds(1000000));
        Progress quiet;
        const TimedPicture taken = take_picture_in_time(RadiosityFunction(s), options, quiet, stop);
        EXPECT_TRUE(taken.is_complete);
        EXPECT_EQ(taken.samples, 5);
        EXPECT_EQ(taken.block, 1);
        expect_same_light(taken.picture, whole);
    }
}

TEST(TakePictureInTime, IsCompleteInSquaresIfAStopEndsTheNextPass) {
    const Solution s = sample_solution();
    const TimedPicture taken = stopped_picture(s, {{{0.1, 0.1, 0.5}, {1.5, 0.5, 0.5}, 70}, {300, 200}, 16}, 2);
    EXPECT_FALSE(taken.is_complete);
    EXPECT_EQ(taken.samples, 0);
    EXPECT_EQ(taken.block, 128);
    const auto pixel = [&](int x, int y) { return taken.picture.pixels[static_cast<std::size_t>(300 * y + x)]; };
    for (int y = 0; y < 200; ++y)
        for (int x = 0; x < 300; ++x) {
            EXPECT_EQ(pixel(x, y).front, 1) << x << " " << y;
            EXPECT_EQ(pixel(x, y).irradiance, pixel(x - x % 128, y - y % 128).irradiance);
        }
    EXPECT_NE(pixel(0, 0).irradiance, pixel(299, 199).irradiance);
}

TEST(TakePictureInTime, ReportsThatNothingWasPaintedIfTheFirstPassIsStopped) {
    const TimedPicture taken =
        stopped_picture(sample_solution(), {{{0.1, 0.1, 0.5}, {1.5, 0.5, 0.5}, 70}, {300, 200}, 16}, 1);
    EXPECT_EQ(taken.block, 0);
    EXPECT_FALSE(taken.is_complete);
}

}  // namespace
}  // namespace exitance
