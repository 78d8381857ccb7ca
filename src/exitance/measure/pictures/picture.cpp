#include "exitance/measure/pictures/picture.hpp"

#include <algorithm>
#include <cmath>

#include "exitance/base/parallel.hpp"
#include "exitance/measure/pictures/pixel_hits.hpp"
#include "exitance/measure/pictures/tile_light.hpp"
#include "exitance/measure/pictures/timed_picture.hpp"
#include "exitance/mesh/element_locator.hpp"
#include "exitance/processes/distributed.hpp"
#include "exitance/transport/stage.hpp"

namespace exitance {
namespace {

/// Maps a uniform number in [0, 1) to a number in [-1, 1] with the density of a tent.
double tent(double u) {
    return u < 0.5 ? std::sqrt(2 * u) - 1 : 1 - std::sqrt(2 - 2 * u);
}

/// Positions of a pixel's rays relative to its centre, in pixels. The first 2^k of them are stratified for every k.
std::vector<Vec2> places_about_pixel(int samples, std::uint64_t seed) {
    if (samples == 1) return {{0, 0}};
    const ScrambledSobol sobol(hash(seed, static_cast<std::uint64_t>(Stream::mesh)));
    std::vector<Vec2> places;
    for (int i = 0; i < samples; ++i) {
        const auto index = static_cast<std::uint32_t>(i);
        places.push_back({tent(sobol(index, 0)), tent(sobol(index, 1))});
    }
    return places;
}

int tile_columns(PictureSize size) {
    return (size.width + tile_side - 1) / tile_side;
}

std::size_t tile_count(PictureSize size) {
    return static_cast<std::size_t>(tile_columns(size)) *
           static_cast<std::size_t>((size.height + tile_side - 1) / tile_side);
}

/// A pass over a whole picture. Its pixels are squares of `block` x `block` pixels of the requested picture.
struct Pass {
    int block = 1;
    int samples = 1;  ///< Rays per square.

    PictureSize size(PictureSize whole) const {
        return {(whole.width + block - 1) / block, (whole.height + block - 1) / block};
    }
};

/// Renders tiles of a pass one after the other. One per thread.
class TilePainter {
  public:
    TilePainter(const RadiosityFunction& light, const PictureOptions& options, const Pass& pass,
                std::span<const Vec2> places, double brightness, const StopRequest& stop, const ShownIrradiance& shown)
        : scene_(light.solution().scene),
          tracer_(light.stage().tracer),
          options_(options),
          pass_(pass),
          size_(pass.size(options.size)),
          rays_(options.camera, options.size),
          places_(places),
          light_(light, static_cast<std::uint32_t>(places.size()), options.gather, options.seed, SpotPoints::any,
                 brightness) {
        light_.use(stop), light_.interpolate_below(options.interpolation);
        if (shown) light_.show(shown);
    }

    /// Renders the tile whose upper left pixel is (x0, y0) into a picture of the pass's size.
    void paint(int x0, int y0, Picture& picture) {
        const int x1 = std::min(x0 + tile_side, size_.width);
        const int y1 = std::min(y0 + tile_side, size_.height);
        trace(x0, x1, y0, y1);
        spots_.clear(), points_.clear();
        std::size_t pixel_in_tile = 0;
        for (int y = y0; y < y1; ++y)
            for (int x = x0; x < x1; ++x) {
                const Spot pixel{{}, x - x0, y - y0, at(x, y)};
                sort_by_region(pixel_in_tile++, pixel, picture.pixels[at(x, y)]);
            }
        light_.evaluate(points_, spots_);
        for (const Spot& spot : spots_) add(spot, picture.pixels[spot.pixel]);
        for (int y = y0; y < y1; ++y)
            for (int x = x0; x < x1; ++x) finish(picture.pixels[at(x, y)]);
    }

  private:
    std::uint32_t at(int x, int y) const {
        return static_cast<std::uint32_t>(y) * static_cast<std::uint32_t>(size_.width) + static_cast<std::uint32_t>(x);
    }

    /// Position of a ray in the requested picture along one axis, in pixels: `place` pixels from the centre of pixel
    /// `i` of the pass. Rays of squares that extend beyond the border are moved inside.
    double at_pixel(int i, double place, int pixels) const {
        return pass_.block == 1 ? i + 0.5 + place : std::min(pass_.block * (i + 0.5 + place), pixels - 0.5);
    }

    /// Traces the rays of all pixels of a tile, pixel by pixel.
    void trace(int x0, int x1, int y0, int y1) {
        origins_.clear(), directions_.clear(), ends_.clear();
        Point origin;
        Vec3 direction;
        for (int y = y0; y < y1; ++y)
            for (int x = x0; x < x1; ++x) {
                for (const Vec2& place : places_) {
                    const double u = at_pixel(x, place.x, options_.size.width);
                    const double v = at_pixel(y, place.y, options_.size.height);
                    if (!rays_.ray(u, v, origin, direction)) continue;
                    origins_.push_back(origin), directions_.push_back(direction);
                }
                ends_.push_back(directions_.size());
            }
        hits_.resize(directions_.size());
        if (options_.camera.projection == Projection::orthographic)
            tracer_.nearest(origins_, directions_, RegionId(), hits_);
        else
            tracer_.nearest(directions_, options_.camera.eye, RegionId(), hits_);
    }

    /// Makes one spot for every region that the pixel's rays hit.
    void sort_by_region(std::size_t pixel_in_tile, const Spot& pixel, Pixel& out) {
        const std::size_t first = pixel_in_tile == 0 ? 0 : ends_[pixel_in_tile - 1], last = ends_[pixel_in_tile];
        met_.clear();
        for (std::size_t i = first; i < last; ++i) {
            const RayHit& hit = hits_[i];
            const bool front = !hit.surface.is_none() && hit.front;
            met_.push_back(front ? hit.region : RegionId());
            if (!hit.surface.is_none()) (hit.front ? out.front : out.back) += 1;
        }
        if (met_.size() == places_.size() && std::equal(met_.begin() + 1, met_.end(), met_.begin()))
            out.region = met_.front();
        for (std::size_t i = 0; i < met_.size(); ++i) {
            if (met_[i].is_none()) continue;
            const RegionId region = met_[i];
            Spot spot = pixel;
            spot.region = region, spot.first = static_cast<std::uint32_t>(points_.size());
            for (std::size_t k = i; k < met_.size(); ++k) {
                if (met_[k] != region) continue;
                points_.push_back(origins_[first + k] + hits_[first + k].distance * directions_[first + k]);
                met_[k] = RegionId(), ++spot.count;
            }
            spots_.push_back(spot);
        }
    }

    /// Radiance of an emitter towards the eye over that of a diffuse one: mean over a spot.
    double radiance_towards_eye(const Spot& spot) const {
        const RelativeRadiance radiance = scene_.relative_radiance(spot.region);
        if (!radiance.is_directed()) return 1;
        const bool parallel = options_.camera.projection == Projection::orthographic;
        double sum = 0;
        for (std::uint32_t i = 0; i < spot.count; ++i)
            sum += parallel ? radiance(-normalized(directions_.front()))
                            : radiance.towards(options_.camera.eye, points_[spot.first + i]);
        return sum / spot.count;
    }

    void add(const Spot& spot, Pixel& pixel) const {
        const Material& material = scene_.material(spot.region);
        Spectrum radiosity = material.reflectance * spot.irradiance;
        if (material.emits()) radiosity += radiance_towards_eye(spot) * material.exitance;
        pixel.irradiance += spot.count * spot.irradiance;
        pixel.radiosity += spot.count * radiosity;
        if (!material.emits()) return;
        pixel.from_lamps += spot.count * radiosity;
        pixel.emitting += static_cast<float>(spot.count);
    }

    void finish(Pixel& pixel) const {
        const auto all = static_cast<float>(places_.size());
        if (pixel.front > 0) pixel.radiosity *= 1 / pixel.front, pixel.irradiance *= 1 / pixel.front;
        if (pixel.emitting > 0) pixel.from_lamps *= 1 / pixel.emitting;
        pixel.front /= all, pixel.back /= all, pixel.emitting /= all;
    }

    const Scene& scene_;
    const RayTracer& tracer_;
    const PictureOptions& options_;
    const Pass pass_;
    const PictureSize size_;  ///< Size of the pass.
    CameraRays rays_;
    std::span<const Vec2> places_;
    TileLight light_;
    std::vector<Point> origins_, points_;
    std::vector<Vec3> directions_;
    std::vector<RayHit> hits_;
    std::vector<std::size_t> ends_;  ///< End of every pixel's rays.
    std::vector<RegionId> met_;
    std::vector<Spot> spots_;
};

/// Median irradiance of the exported elements over some pixels that show fronts, W/m^2.
double usual_brightness(const RadiosityFunction& light, const PictureOptions& options) {
    constexpr int side = 24;  // number of sampled pixels in each direction
    const Solution& solution = light.solution();
    const CameraRays rays(options.camera, options.size);
    std::vector<ProbePoint> places;
    for (int i = 0; i < side * side; ++i) {
        Point origin;
        Vec3 direction;
        RayHit hit;
        const double x = (i % side + 0.5) / side * options.size.width,
                     y = (i / side + 0.5) / side * options.size.height;
        if (!rays.ray(x, y, origin, direction)) continue;
        light.stage().tracer.nearest(std::span(&direction, 1), origin, RegionId(), std::span(&hit, 1));
        if (hit.surface.is_none() || !hit.front) continue;
        places.push_back({origin + hit.distance * direction, solution.scene.surfaces()[hit.surface].normal});
    }
    std::vector<double> E;
    for (const Light& there : light.interpolant_at(places)) E.push_back(mean(there.irradiance));
    if (E.empty()) return 0;
    const auto middle = E.begin() + static_cast<std::ptrdiff_t>(E.size() / 2);
    std::nth_element(E.begin(), middle, E.end());
    return *middle;
}

/// Sends the tiles [first, first + count) of a picture to all processes; `grain` consecutive tiles belong to one
/// process.
void exchange_tiles(std::size_t first, std::size_t count, std::size_t grain, Picture& picture,
                    std::span<std::uint8_t> finished) {
    const auto columns = static_cast<std::size_t>(tile_columns(picture.size));
    const auto width = static_cast<std::size_t>(picture.size.width),
               height = static_cast<std::size_t>(picture.size.height);
    constexpr auto side = static_cast<std::size_t>(tile_side);
    const auto row_of_tile = [&](std::size_t k) {
        const std::size_t tile = first + k / side, x = tile % columns * side, y = tile / columns * side + k % side;
        if (y >= height) return std::span<Pixel>();
        return std::span(picture.pixels).subspan(y * width + x, std::min(side, width - x));
    };
    exchange_values(count * side, grain * side, row_of_tile, "tiles");
    exchange_values(
        count, grain, [&](std::size_t k) -> std::uint8_t& { return finished[first + k]; }, "tiles");
}

/// Renders one pass. `finished`: 1 for each completed tile, row by row; 0 for those that a stop left unfinished.
Picture paint(const RadiosityFunction& light, const PictureOptions& options, const Pass& pass, double brightness,
              Progress& progress, const StopRequest& stop, const ShownIrradiance& shown,
              std::vector<std::uint8_t>& finished) {
    Picture picture{pass.size(options.size), {}};
    picture.pixels.resize(picture.size.pixels());
    const std::vector<Vec2> places = places_about_pixel(pass.samples, options.seed);
    const auto columns = static_cast<std::size_t>(tile_columns(picture.size));
    const std::size_t tiles = tile_count(picture.size);
    finished.assign(tiles, 0);
    // A painter, whose memory is reused, paints several tiles; slow tiles, with a gather, are distributed one by one.
    // Processes need smaller parts than threads, which take the next part when they have finished one.
    const std::size_t grain = options.gather > 0 ? 1
                              : processes() > 1  ? 2
                                                 : 8,
                      at_once = (options.gather > 0 ? 16 : 256) * processes();
    for (std::size_t first = 0; first < tiles && !stop.requested(); first += at_once) {
        progress.advance(static_cast<double>(first) / static_cast<double>(tiles));
        const std::size_t count = std::min(at_once, tiles - first);
        parallel_own_ranges(count, grain,
                            [&](std::size_t begin, std::size_t end) {
                                TilePainter painter(light, options, pass, places, brightness, stop, shown);
                                for (std::size_t i = first + begin; i < first + end && !stop.requested(); ++i) {
                                    painter.paint(static_cast<int>(i % columns) * tile_side,
                                                  static_cast<int>(i / columns) * tile_side, picture);
                                    finished[i] = !stop.requested();
                                }
                            },
                            {"tiles"});
        exchange_tiles(first, count, grain, picture, finished);
    }
    return picture;
}

/// Copies the finished tiles of a pass into the whole picture, each pixel to all pixels of its square.
void copy_finished(const Picture& from, const Pass& pass, std::span<const std::uint8_t> finished, Picture& to) {
    const auto columns = static_cast<std::size_t>(tile_columns(from.size));
    for (int y = 0; y < to.size.height; ++y)
        for (int x = 0; x < to.size.width; ++x) {
            const int i = x / pass.block, k = y / pass.block;
            if (!finished[static_cast<std::size_t>(k / tile_side) * columns + static_cast<std::size_t>(i / tile_side)])
                continue;
            to.pixels[static_cast<std::size_t>(y) * static_cast<std::size_t>(to.size.width) +
                      static_cast<std::size_t>(x)] =
                from.pixels[static_cast<std::size_t>(k) * static_cast<std::size_t>(from.size.width) +
                            static_cast<std::size_t>(i)];
        }
}

/// Passes from one ray per square of 128 x 128 pixels to all samples in every pixel; each has about four times the rays
/// of the previous one.
std::vector<Pass> passes_to(int samples) {
    std::vector<Pass> passes;
    for (int block = 128; block > 1; block /= 2) passes.push_back({block, 1});
    for (int few = 1; few < samples; few *= 4) passes.push_back({1, few});
    passes.push_back({1, samples});
    return passes;
}

/// The finest pass after `last` that fits into the remaining time if rays take as long as in `last`; at least the next.
/// Equal in all processes. Collective.
std::size_t next_pass(std::span<const Pass> passes, std::size_t last, PictureSize whole, double seconds,
                      const StopRequest& stop) {
    const double left = common_seconds_left(stop);
    const auto all_threads = processes() * static_cast<std::size_t>(as_first(threads()));
    const auto seconds_on = [&](const Pass& pass, std::size_t at_once) {
        return static_cast<double>(pass.size(whole).pixels()) * pass.samples / static_cast<double>(at_once);
    };
    // A pass does not use more threads than it has tiles.
    const auto busy = [&](const Pass& pass) { return std::min(tile_count(pass.size(whole)), all_threads); };
    // Without a deadline only a signal may end the picture; a pass with squares of 8 x 8 pixels is made for that case.
    if (std::isinf(left) && passes[last].block > 8)
        return static_cast<std::size_t>(
            std::find_if(passes.begin(), passes.end(), [](const Pass& pass) { return pass.block == 8; }) -
            passes.begin());
    const double rate = as_first(seconds) / seconds_on(passes[last], busy(passes[last]));
    std::size_t next = passes.size() - 1;
    while (next > last + 1 && rate * seconds_on(passes[next], busy(passes[next])) > left) --next;
    return next;
}

}  // namespace

Picture take_picture(const RadiosityFunction& light, const PictureOptions& options, Progress& progress,
                     const StopRequest& stop) {
    return take_picture_of({}, light, options, progress, stop);
}

Picture take_picture_of(const ShownIrradiance& shown, const RadiosityFunction& light, const PictureOptions& options,
                        Progress& progress, const StopRequest& stop) {
    progress.phase("render");
    std::vector<std::uint8_t> finished;
    return paint(light, options, {1, options.samples}, usual_brightness(light, options), progress, stop, shown,
                 finished);
}

TimedPicture take_picture_in_time(const RadiosityFunction& light, const PictureOptions& options, Progress& progress,
                                  const StopRequest& stop, const ShownIrradiance& shown) {
    progress.phase("render");
    const double brightness = usual_brightness(light, options);
    const std::vector<Pass> passes = passes_to(options.samples);
    TimedPicture out{.picture = {options.size, std::vector<Pixel>(options.size.pixels())}};
    for (std::size_t i = 0; i < passes.size();) {
        const Pass& pass = passes[i];
        const Stopwatch watch;
        std::vector<std::uint8_t> finished;
        Picture painted = paint(light, options, pass, brightness, progress, stop, shown, finished);
        const bool is_whole = std::find(finished.begin(), finished.end(), 0) == finished.end();
        if (is_whole) out.samples = pass.block == 1 ? pass.samples : 0, out.block = pass.block;
        if (is_whole && pass.block == 1)
            out.picture = std::move(painted);
        else if (out.block > 0)
            copy_finished(painted, pass, finished, out.picture);
        out.is_complete = is_whole && i + 1 == passes.size();
        if (stop.requested()) break;
        i = i + 1 == passes.size() ? passes.size() : next_pass(passes, i, options.size, watch.seconds(), stop);
    }
    return out;
}

std::vector<bool> element_edges(const ElementTree& tree, const Scene& scene, const RayTracer& tracer,
                                const Camera& camera, PictureSize size) {
    const ElementLocator locator(tree, scene.regions().size());
    std::vector<ElementId> seen(size.pixels());
    for_visible_fronts(tracer, camera, size, [&](std::size_t pixel, const RayHit& hit, const Point& at) {
        seen[pixel] = locator.find(hit.region, at).element;
    });
    const auto width = static_cast<std::size_t>(size.width);
    std::vector<bool> edges(seen.size());
    for (std::size_t i = 0; i < seen.size(); ++i) {
        const bool right = (i + 1) % width != 0 && seen[i] != seen[i + 1];
        const bool below = i + width < seen.size() && seen[i] != seen[i + width];
        edges[i] = right || below;
    }
    return edges;
}

}  // namespace exitance
