#include "exitance/cli/standards_arguments.hpp"

#include "exitance/cli/option_kinds.hpp"
#include "exitance/io/files/text_table.hpp"

namespace exitance {
namespace {

/// "0.75", "desk", "desk,height=0.1,border=0.2,spacing=0.5"
PlaneRequest read_request(const std::string& option, const std::string& words) {
    PlaneRequest out;
    std::istringstream in(words);
    std::string word;
    std::getline(in, word, ',');
    if (double height = 0; CLI::detail::lexical_cast(word, height))
        out.height = read_number(option, word);
    else
        out.group = word;
    if (word.empty()) throw CLI::ValidationError(option, "begins with a height in metres or with a name of faces");
    while (std::getline(in, word, ',')) {
        const std::size_t at = word.find('=');
        const std::string key = word.substr(0, at);
        const double value = at == std::string::npos ? -1 : read_number(option, word.substr(at + 1));
        const bool known = key == "height" || key == "border" || key == "spacing";
        if (!known || !(value >= 0) || (key == "spacing" && value == 0))
            throw CLI::ValidationError(option, fmt::format("'{}' is not height=H, border=B or spacing=S", word));
        if (key == "height") out.height = value;
        if (key == "border") out.border = value;
        if (key == "spacing") out.spacing = value;
    }
    return out;
}

CLI::Option* add_planes(CLI::App& app, const std::string& name, std::vector<PlaneRequest>& planes, bool cylindrical,
                        const std::string& help) {
    const auto read = [name, cylindrical, &planes](const std::vector<std::string>& all) {
        for (const std::string& words : all) {
            planes.push_back(read_request(name, words));
            planes.back().is_cylindrical = cylindrical;
            if (cylindrical && !planes.back().height) throw CLI::ValidationError(name, "needs a height in metres");
        }
    };
    return app.add_option_function<std::vector<std::string>>(name, read, help)
        ->type_name("PLANE")
        ->expected(1)
        ->take_all();
}

/// In the middle of each wall of the largest floor, looking across it, as CIE 117 has them.
Result<std::vector<Observer>> standard_observers(const Scene& scene) {
    constexpr double seated = 1.2, off_wall = 0.1;  // metres
    PlaneRequest request;
    request.height = seated;
    const Result<std::vector<GridLight>> planes = make_working_planes(scene, request);
    if (!planes) return planes.error();
    const MeasuringPlane& plane = planes->front().plane;
    const Point middle = plane.origin + 0.5 * (plane.u + plane.v);
    std::vector<Observer> out;
    const std::array<std::pair<const char*, Vec3>, 4> walls{{{"along u", -0.5 * plane.u},
                                                             {"against u", 0.5 * plane.u},
                                                             {"along v", -0.5 * plane.v},
                                                             {"against v", 0.5 * plane.v}}};
    for (const auto& [name, way] : walls)
        out.push_back({name, middle + way - off_wall * normalized(way), -1 * normalized(way)});
    return out;
}

Result<std::vector<Observer>> load_observers(const std::string& path) {
    Result<NumberTable> table = NumberTable::open(path, {"x", "y", "z", "dx", "dy", "dz"});
    if (!table) return table.error();
    std::vector<Observer> out;
    for (std::array<double, 6> row;;) {
        const Result<bool> more = table->next(row);
        if (!more) return more.error();
        if (!*more) break;
        const Vec3 view{row[3], row[4], row[5]};
        if (!(norm(view) > 0)) return table->lines().error("looks in no direction", "dx, dy, dz must not all be 0");
        out.push_back({fmt::format("{}", out.size() + 1), {row[0], row[1], row[2]}, normalized(view)});
    }
    if (out.empty()) return Error{ErrorCode::bad_input, "holds no observers", path, "x,y,z,dx,dy,dz and a row each"};
    return out;
}

}  // namespace

Result<std::vector<Observer>> find_observers(const std::string& words, const Scene& scene) {
    if (words == "auto") return standard_observers(scene);
    if (words.find_first_not_of("0123456789.,+-eE ") != std::string::npos) return load_observers(words);
    std::string blank = words;
    std::replace(blank.begin(), blank.end(), ',', ' ');
    std::istringstream in(blank);
    std::vector<double> n;
    for (double value; in >> value;) n.push_back(value);
    const Vec3 view = n.size() == 6 ? Vec3{n[3], n[4], n[5]} : Vec3();
    if (!in.eof() || !(norm(view) > 0))
        return Error{ErrorCode::usage, fmt::format("'{}' is not 'x,y,z dx,dy,dz'", words), "--observers",
                     "an eye in metres and the direction in which it looks"};
    return std::vector<Observer>{{words, {n[0], n[1], n[2]}, normalized(view)}};
}

void declare_standards(CLI::App& app, ReportArguments& arguments) {
    add_planes(app, "--plane", arguments.working_planes, false,
               "Working plane of EN 12464-1: '0.75' (metres above the floor) or faces by name, 'desk' (on them) or "
               "'hall,height=0.75'; and border=B (default 0.5 m above floors), spacing=S (default the standard's). May "
               "be given again");
    add_planes(app, "--cylindrical", arguments.working_planes, true,
               "The same for cylindrical illuminance, '1.2' or 'hall,height=1.6'");
    add_positive(app, "--maintenance", arguments.maintenance, "FACTOR",
                 "What light on planes is multiplied by, for age and dirt; at most 1, default 1")
        ->check(CLI::Range(0.0, 1.0));
    app.add_option("--observers", arguments.observers,
                   "Glare (UGR) for observers: 'x,y,z dx,dy,dz' (eye and line of sight), a table (CSV x,y,z,dx,dy,dz), "
                   "or auto: at 1.2 m in the middle of each wall. May be given again")
        ->type_name("OBSERVERS")
        ->expected(1)
        ->take_all();
    app.add_option("--tables", arguments.tables,
                   "Folder for planes.csv, plane_1.csv, plans with lines of equal light (plane_1.svg, .pdf), ..., "
                   "observers.csv")
        ->type_name("FOLDER");
}

}  // namespace exitance
