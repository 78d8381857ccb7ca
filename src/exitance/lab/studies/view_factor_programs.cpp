#include "exitance/lab/studies/view_factor_programs.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <filesystem>

#include "exitance/base/triangulation.hpp"
#include "exitance/io/files/atomic_file.hpp"
#include "exitance/io/files/child_process.hpp"
#include "exitance/io/files/text_table.hpp"
#include "exitance/io/files/whole_file.hpp"

namespace exitance {

namespace {

constexpr double min_compared = 1e-5;

/// True for four corners of which each is convex.
bool is_convex_quadrangle(std::span<const Point> p, const Normal& n) {
    if (p.size() != 4) return false;
    for (std::size_t i = 0; i < 4; ++i)
        if (dot(n, cross(p[(i + 1) % 4] - p[i], p[(i + 2) % 4] - p[(i + 1) % 4])) <= 0) return false;
    return true;
}

/// Reads a CSV file written by `exitance viewfactors`.
Result<AreaMatrix> read_own_result(const std::string& path, std::size_t n) {
    const Result<Table> table = read_csv(path);
    if (!table) return table.error();
    if (table->rows.size() != n || table->columns.size() != n + 3)
        return Error{ErrorCode::bad_input, fmt::format("it is not the matrix of {} surfaces", n), path, ""};
    AreaMatrix matrix;
    for (const std::vector<std::string>& row : table->rows) {
        matrix.areas.push_back(parse_number(row[1]).value_or(NAN));
        for (std::size_t j = 0; j < n; ++j) matrix.factors.push_back(parse_number(row[j + 3]).value_or(NAN));
    }
    return matrix;
}

double reciprocity_defect(const AreaMatrix& m) {
    const std::size_t n = m.areas.size();
    double defect = 0;
    for (std::size_t i = 0; i < n; ++i) {
        const double* row = &m.factors[i * n];
        const double most = m.areas[i] * *std::max_element(row, row + n);
        if (most <= 0) continue;
        for (std::size_t j = 0; j < n; ++j)
            defect = std::max(defect, std::abs(m.areas[i] * row[j] - m.areas[j] * m.factors[j * n + i]) / most);
    }
    return defect;
}

void add_errors(Table& out, const AreaMatrix& m, const AreaMatrix& reference) {
    const std::size_t n = m.areas.size();
    double row_error = 0;
    std::vector<double> errors;
    for (std::size_t i = 0; i < n; ++i) {
        double sum = 0;
        for (std::size_t j = 0; j < n; ++j) {
            const double f = m.factors[i * n + j], r = reference.factors[i * n + j];
            sum += f - r;
            if (r > min_compared) errors.push_back(std::abs(f - r) / r);
        }
        row_error = std::max(row_error, std::abs(sum));
    }
    std::sort(errors.begin(), errors.end());
    const auto at = [&](double share) {
        return errors.empty() ? 0.0 : errors[static_cast<std::size_t>(share * static_cast<double>(errors.size() - 1))];
    };
    out.set("row_error", field(row_error)), out.set("median_error", field(at(0.5)));
    out.set("p99_error", field(at(0.99))), out.set("largest_error", field(at(1)));
    out.set("reciprocity", field(reciprocity_defect(m)));
}

/// A run of one program, and its matrix.
struct MatrixRun {
    ProgramRun program;
    Result<AreaMatrix> matrix;
};

/// The matrices of one scene by all programs.
class MatrixRuns {
  public:
    MatrixRuns(const std::string& scene_file, const Scene& scene, const ViewFactorProgramOptions& options,
               const StopRequest& stop)
        : scene_file_(std::filesystem::absolute(scene_file)), scene_(scene), options_(options), stop_(stop) {}

    MatrixRun own(double tolerance) const {
        const std::string out = path("own.csv");
        const ProgramRun run = run_program({options_.program, "viewfactors", scene_file_, "-o", out, "--tolerance",
                                            fmt::format("{:g}", tolerance), "--threads", "1", "--check", "0", "-q"},
                                           options_.folder, options_.time_limit, stop_);
        return {run, read_own_result(out, scene_.surfaces().size())};
    }

    MatrixRun view3d(const std::string& name, double eps) const {
        const std::string in = path("scene.vs3"), out = path("scene.vf");
        if (const Result<void> written = write_file(in, view3d_text(scene_, eps)); !written)
            return {{}, written.error()};
        const ProgramRun run = run_program({name, in, out}, options_.folder, options_.time_limit, stop_);
        return {run, read_view3d_result(out, scene_.surfaces().size())};
    }

  private:
    /// Returns the path of a file after removing that of earlier runs.
    std::string path(const char* name) const {
        const std::filesystem::path file = std::filesystem::absolute(options_.folder) / name;
        std::error_code none;
        std::filesystem::remove(file, none);
        return file;
    }

    std::string scene_file_;
    const Scene& scene_;
    const ViewFactorProgramOptions& options_;
    const StopRequest& stop_;
};

/// Exit code of `exitance viewfactors` if some pairs of rows disagree by more than the tolerance; the matrix is
/// written.
constexpr int not_reached_status = 4;

std::string status_of(const MatrixRun& run) {
    if (run.program.out_of_time) return "time limit";
    if (run.program.status == not_reached_status && run.matrix) return "not reached";
    if (run.program.status != 0) return fmt::format("failed: status {}", run.program.status);
    return run.matrix ? "done" : "failed: " + run.matrix.error().message;
}

}  // namespace

std::string view3d_text(const Scene& scene, double eps) {
    struct Piece {
        std::array<std::size_t, 4> corners;  ///< Numbers of vertices; 0 instead of a fourth one.
        SurfaceId face;
    };
    std::string vertices, text;
    std::vector<Piece> pieces;
    std::size_t vertex = 0;
    for (const SurfaceId s : scene.surfaces().ids()) {
        const std::span<const Point> outline = scene.outline(s);
        const std::size_t first = vertex + 1;
        for (const Point& p : outline)
            vertices += fmt::format("V {} {:.12g} {:.12g} {:.12g}\n", ++vertex, p.x, p.y, p.z);
        const Normal& n = scene.surfaces()[s].normal;
        if (is_convex_quadrangle(outline, n))
            pieces.push_back({{first, first + 1, first + 2, first + 3}, s});
        else
            for (const auto& t : triangulate(outline, n))
                pieces.push_back({{first + t[0], first + t[1], first + t[2], 0}, s});
    }
    std::size_t number = 0, first_of_face = 0;
    for (const auto& [corners, face] : pieces) {
        const auto& [a, b, c, d] = corners;
        const bool goes_on = number > 0 && pieces[number - 1].face == face;
        if (!goes_on) first_of_face = number + 1;
        text += fmt::format("S {} {} {} {} {} 0 {} {:.4g} f{}\n", ++number, a, b, c, d, goes_on ? first_of_face : 0,
                            1 - mean(scene.material(face).reflectance), face.value + 1);
    }
    for (const auto& [corners, face] : pieces) {
        const auto& [a, b, c, d] = corners;
        if (d == 0)
            text += fmt::format("O {} {} {} {} 0\n", ++number, c, b, a);
        else
            text += fmt::format("O {} {} {} {} {}\n", ++number, d, c, b, a);
    }
    return fmt::format("T exitance\nC eps={:g} out=1\nF 3\n{}{}E\n", eps, vertices, text);
}

Result<AreaMatrix> read_view3d_result(const std::string& path, std::size_t n) {
    const Result<std::string> content = read_whole_file(path);
    if (!content) return content.error();
    constexpr std::size_t header = 32;
    if (content->size() != header + sizeof(float) * (2 * n + n * n))
        return Error{ErrorCode::bad_input, fmt::format("it is not View3D's matrix of {} surfaces", n), path, ""};
    std::vector<float> numbers(n + n * n);
    std::memcpy(numbers.data(), content->data() + header, sizeof(float) * numbers.size());
    const auto areas_end = numbers.begin() + static_cast<std::ptrdiff_t>(n);
    return AreaMatrix{{numbers.begin(), areas_end}, {areas_end, numbers.end()}};
}

Result<void> compare_view_factor_programs(const std::string& scene_name, const std::string& scene_file,
                                          const Scene& scene, const ViewFactorProgramOptions& options, Table& out,
                                          const StopRequest& stop) {
    const MatrixRuns runs(scene_file, scene, options, stop);
    const auto begin = [&](const std::string& program, double setting) {
        out.add_row();
        out.set("scene", scene_name), out.set("polygons", std::to_string(scene.surfaces().size()));
        out.set("program", program), out.set("setting", field(setting));
    };
    const auto add = [&](const std::string& program, double setting, const MatrixRun& run,
                         const AreaMatrix& reference) {
        begin(program, setting);
        out.set("status", status_of(run));
        out.set("processor_seconds", field(run.program.processor_seconds));
        out.set("wall_seconds", field(run.program.seconds));
        out.set("peak_bytes", std::to_string(run.program.peak_bytes));
        if (run.matrix) add_errors(out, *run.matrix, reference);
    };

    const MatrixRun careful = runs.own(options.reference_tolerance);
    if (stop.requested()) return {};
    if (!careful.matrix)
        return Error{ErrorCode::bad_input, fmt::format("no reference for {}: {}", scene_name, status_of(careful)),
                     scene_file, "raise time_limit"};
    for (const double tolerance : options.tolerances) {
        const MatrixRun run = runs.own(tolerance);
        if (stop.requested()) return {};
        add("exitance", tolerance, run, *careful.matrix);
    }
    const std::string view3d = is_program("View3D") ? "View3D" : "view3d";
    for (const double eps : options.convergence) {
        if (!is_program(view3d)) {
            begin("View3D", eps);
            out.set("status", "not run: there is no 'View3D'");
            continue;
        }
        const MatrixRun run = runs.view3d(view3d, eps);
        if (stop.requested()) return {};
        add("View3D", eps, run, *careful.matrix);
    }
    return {};
}

}  // namespace exitance
