#pragma once

#include "exitance/io/report/report.hpp"

namespace exitance {

/// The numbers of a report, found once for the page and for its JSON twin.
struct ReportFigures {
    struct Face {
        SurfaceId surface;
        int line = 0;
        std::string group, material;
        double area = 0;  ///< m^2
        Levels irradiance;
        double radiosity = 0;  ///< Mean.
    };
    struct MaterialUse {
        std::string name;
        std::array<double, 3> reflectance, radiance;
        std::size_t faces = 0;
        double area = 0;        ///< m^2
        double irradiance = 0;  ///< Mean over its faces by area.
    };
    struct Grid {
        const GridLight* light;
        std::vector<double> values;  ///< Of every point.
        Levels levels;               ///< Of those in the open.
        std::size_t hidden = 0;      ///< How many are not.
    };
    std::vector<Face> faces;  ///< By area, largest first.
    std::vector<MaterialUse> materials;
    std::vector<Grid> grids;
    double area = 0;  ///< Of all surfaces, m^2.
};

ReportFigures find_figures(const ReportContent& content);

/// "W/m²" or "lx".
const char* symbol(const LightUnit& unit);

/// A number as pages and files show it: five significant digits.
std::string figure(double value);

/// The same for narrow places: three significant digits, without powers of ten up to a million.
std::string short_figure(double value);

/// The numbers as JSON.
std::string report_json(const ReportContent& content, const ReportFigures& figures);

/// The observers of a report as items of a JSON array, and as a part of the page (empty without any).
std::string observer_json(const ObserverGlare& observer);
std::string observers_html(const ReportContent& content);
/// Text within HTML.
std::string escaped(const std::string& text);

/// A plan of a grid in false colours with lines of equal light (SVG), and what the colours mean (HTML).
std::string grid_plan(const ReportFigures::Grid& grid, const LightUnit& unit);

/// A canvas that shows the scene with its light maps, and the script that turns it (HTML); empty without maps.
Result<std::string> report_viewer(const ReportContent& content);

/// A picture within a page: its address.
Result<std::string> data_address(const Image& image);

}  // namespace exitance
