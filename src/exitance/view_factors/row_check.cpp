#include "exitance/view_factors/row_check.hpp"

#include <algorithm>
#include <cmath>

#include "exitance/form_factors/hemisphere.hpp"
#include "exitance/processes/distributed.hpp"

namespace exitance {
namespace {

constexpr std::size_t block = 1024;

std::vector<double> dense_row(const SparseFactors& table, std::size_t i) {
    std::vector<double> row(table.size());
    for (std::size_t k = 0; k < table.row_columns(i).size(); ++k) row[table.row_columns(i)[k]] = table.row_values(i)[k];
    return row;
}

Point middle_of(const ViewFace& face) {
    return 0.5 * (face.box.lo + face.box.hi);
}

/// Indicator of a random number of faces nearest to a given one: 1 for these, 0 for the others.
std::vector<double> random_group(const RowScene& ready, std::size_t centre, RandomStream& random) {
    const std::size_t n = ready.faces.size();
    const Point middle = middle_of(ready.faces[centre]);
    std::vector<std::pair<double, std::size_t>> near(n);
    for (std::size_t j = 0; j < n; ++j) near[j] = {norm(middle_of(ready.faces[j]) - middle), j};
    const std::size_t count = std::clamp<std::size_t>(std::size_t(std::pow(double(n), random.uniform())), 1, n);
    std::nth_element(near.begin(), near.begin() + std::ptrdiff_t(count) - 1, near.end());
    std::vector<double> x(n);
    for (std::size_t k = 0; k < count; ++k) x[near[k].second] = 1;
    return x;
}

/// Centres of groups: faces that independent rays from a face hit, since those matter most to its row, in turn with
/// faces drawn from all.
std::vector<std::size_t> draw_centres(const RowScene& ready, std::size_t face, const RowCheckOptions& options,
                                      RandomStream& random, const StopRequest& stop) {
    const std::vector<double> share =
        cast_check_rays(ready, face, options.groups, RandomStream(options.seed, Stream::reference, face, 4), stop);
    std::vector<std::size_t> hit, centres;
    for (std::size_t j = 0; j < share.size(); ++j)
        if (share[j] > 0) hit.push_back(j);
    const auto draw = [&](std::size_t n) { return std::min(n - 1, std::size_t(random.uniform() * double(n))); };
    for (std::size_t g = 0; g < options.groups; ++g)
        centres.push_back(g % 2 == 0 || hit.empty() ? draw(share.size()) : hit[draw(hit.size())]);
    return centres;
}

/// Variance of sum_j (F - G1)(F - G2) for multinomial hits: 2 e'Se + tr(SS), S = (diag G - GG') / n.
double squared_error_variance(const std::vector<double>& F, const std::vector<double>& G1,
                              const std::vector<double>& G2, double n) {
    double linear = 0, mean = 0, two = 0, three = 0;
    for (std::size_t j = 0; j < F.size(); ++j) {
        const double G = 0.5 * (G1[j] + G2[j]), e = F[j] - G;
        linear += G * (F[j] - G1[j]) * (F[j] - G2[j]), mean += G * e, two += G * G, three += G * G * G;
    }
    return 2 * std::max(0.0, linear - mean * mean) / n + std::max(0.0, two - 2 * three + two * two) / (n * n);
}

CheckedRow check_row(const RowScene& ready, const std::vector<double>& F, std::size_t face,
                     const RowCheckOptions& options, const StopRequest& stop) {
    const double n = static_cast<double>(options.rays);
    const std::vector<double> G1 =
        cast_check_rays(ready, face, options.rays, RandomStream(options.seed, Stream::reference, face, 1), stop);
    const std::vector<double> G2 =
        cast_check_rays(ready, face, options.rays, RandomStream(options.seed, Stream::reference, face, 2), stop);
    CheckedRow checked;
    checked.face = face;
    for (std::size_t j = 0; j < F.size(); ++j) checked.squared_error += (F[j] - G1[j]) * (F[j] - G2[j]);
    const double one = 1 / (n * n);  // variance of one additional hit, so that the deviation is never zero
    checked.squared_error_deviation = std::sqrt(squared_error_variance(F, G1, G2, n) + one * one);
    RandomStream random(options.seed, Stream::reference, face, 3);
    const std::vector<std::size_t> centres = draw_centres(ready, face, options, random, stop);
    checked.largest_sum_excess = -HUGE_VAL;
    for (std::size_t g = 0; g <= options.groups; ++g) {
        const std::vector<double> x =
            g == 0 ? std::vector<double>(F.size(), 1) : random_group(ready, centres[g - 1], random);
        double sum = 0, share = 0;
        for (std::size_t j = 0; j < F.size(); ++j)
            sum += (F[j] - 0.5 * (G1[j] + G2[j])) * x[j], share += 0.5 * (G1[j] + G2[j]) * x[j];
        const double deviation = std::sqrt(std::max(0.0, share * (1 - share)) / (2 * n) + one / 4);
        checked.largest_sum_error = std::max(checked.largest_sum_error, std::abs(sum));
        checked.largest_sum_deviation = std::max(checked.largest_sum_deviation, deviation);
        checked.largest_sum_excess = std::max(checked.largest_sum_excess, (std::abs(sum) - options.error) / deviation);
    }
    return checked;
}

std::vector<std::size_t> draw_rows(std::span<const std::uint8_t> finished, const RowCheckOptions& options) {
    std::vector<std::size_t> faces;
    for (std::size_t i = 0; i < finished.size(); ++i)
        if (finished[i]) faces.push_back(i);
    RandomStream random(options.seed, Stream::reference, finished.size(), 0);
    const std::size_t count = std::min(options.rows, faces.size());
    for (std::size_t k = 0; k < count; ++k) {  // a random selection: the first steps of a shuffle
        const auto rest = static_cast<double>(faces.size() - k);
        std::swap(faces[k], faces[std::min(faces.size() - 1, k + std::size_t(random.uniform() * rest))]);
    }
    faces.resize(count);
    return faces;
}

}  // namespace

std::vector<double> cast_check_rays(const RowScene& ready, std::size_t face, std::size_t n, RandomStream random,
                                    const StopRequest& stop) {
    const FaceSampler& sampler = ready.samplers[face];
    const Frame frame(sampler.normal());
    std::vector<double> shares(ready.faces.size());
    std::vector<Point> origins;
    std::vector<Vec3> directions;
    std::vector<RayHit> hits(block);
    for (std::size_t first = 0; first < n && !stop.requested(); first += block) {
        origins.clear(), directions.clear();
        for (std::size_t k = first; k < std::min(first + block, n); ++k) {
            const double u = random.uniform(), v = random.uniform(), s = random.uniform(), t = random.uniform();
            const Point x = sampler(u, v);
            if (ready.is_hidden(x, face)) continue;
            origins.push_back(x), directions.push_back(cosine_direction(frame, s, t));
        }
        if (origins.empty()) continue;
        ready.tracer.nearest(origins, directions, ready.region(face), std::span(hits).first(origins.size()));
        for (std::size_t k = 0; k < origins.size(); ++k)
            if (hits[k].front && hits[k].surface.value != face &&
                !ready.ends_hidden(hits[k], origins[k], directions[k]))
                shares[hits[k].surface.value] += 1;
    }
    for (double& share : shares) share /= static_cast<double>(n);
    return shares;
}

RowCheck check_rows_by_rays(const Scene& scene, const SparseFactors& table, const RowCheckOptions& options,
                            const StopRequest& stop) {
    return check_rows_by_rays(
        scene, table.finished, [&](std::size_t i) { return dense_row(table, i); }, options, stop);
}

RowCheck check_rows_by_rays(const Scene& scene, std::span<const std::uint8_t> finished,
                            const std::function<std::vector<double>(std::size_t)>& row_of,
                            const RowCheckOptions& options, const StopRequest& stop) {
    RowCheck check;
    const std::vector<std::size_t> faces = draw_rows(finished, options);
    if (faces.empty()) return check;
    const RowScene ready(scene, stop);
    check.rows.resize(faces.size());
    shared_ranges(
        faces.size(), 1,
        [&](std::size_t from, std::size_t to) {
            for (std::size_t k = from; k < to && !stop.requested(); ++k)
                check.rows[k] = check_row(ready, row_of(faces[k]), faces[k], options, stop);
        },
        [&](std::size_t k) -> CheckedRow& { return check.rows[k]; }, {"checked rows"});
    if (stop.requested()) {
        check.rows.clear(), check.is_complete = false;
        return check;
    }
    double sum = 0;
    for (const CheckedRow& row : check.rows) {
        sum += row.squared_error / static_cast<double>(faces.size());
        check.wrong_sums += row.largest_sum_excess > max_noise_deviations;
        check.sum_error = std::max(check.sum_error, row.largest_sum_error);
        check.detectable_error = std::max(check.detectable_error, row.detectable(options.error, max_noise_deviations));
        check.detectable_sum =
            std::max(check.detectable_sum, options.error + max_noise_deviations * row.largest_sum_deviation);
        check.wrong += std::max(row.squared_excess(options.error), row.largest_sum_excess) > max_noise_deviations;
    }
    check.rays = 2 * options.rays * faces.size();
    check.error = std::sqrt(std::max(0.0, sum));
    return check;
}

}  // namespace exitance
