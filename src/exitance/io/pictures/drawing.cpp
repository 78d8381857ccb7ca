#include "exitance/io/pictures/drawing.hpp"

#include <fmt/format.h>

#include <iterator>

namespace exitance {
namespace {

constexpr double points_per_mm = 72 / 25.4;
constexpr double mean_width = 0.556;    ///< Width of Helvetica's digits over the font height.
constexpr double middle_height = 0.35;  ///< Height of the middle of digits above the baseline, over the font height.

std::string escaped(const std::string& words) {
    std::string out;
    for (const char c : words) out += c == '<' ? "&lt;" : c == '>' ? "&gt;" : c == '&' ? "&amp;" : std::string(1, c);
    return out;
}

/// Converts UTF-8 to a PDF string in ISO 8859-1.
std::string pdf_words(const std::string& words) {
    std::string out;
    for (std::size_t i = 0; i < words.size(); ++i) {
        const auto c = static_cast<unsigned char>(words[i]);
        if (c < 0x80) {
            if (c == '(' || c == ')' || c == '\\') out += '\\';
            out += c < 0x20 ? ' ' : static_cast<char>(c);
            continue;
        }
        const bool is_latin = (c == 0xC2 || c == 0xC3) && i + 1 < words.size();
        out += is_latin ? static_cast<char>(((c & 3) << 6) | (words[i + 1] & 0x3F)) : '?';
        while (i + 1 < words.size() && (words[i + 1] & 0xC0) == 0x80) ++i;
    }
    return out;
}

double width_of(const Drawing::Text& text) {
    return mean_width * text.height * static_cast<double>(text.words.size());
}

void add_line(const Drawing::Line& line, std::string& out) {
    std::string path;
    for (std::size_t i = 0; i < line.points.size(); ++i)
        fmt::format_to(std::back_inserter(path), "{}{:.2f} {:.2f}", i == 0 || (line.pieces && i % 2 == 0) ? "M" : "L",
                       line.points[i].x, line.points[i].y);
    out += fmt::format("<path d=\"{}{}\" fill=\"none\" stroke=\"rgb({},{},{})\" stroke-width=\"{:.2f}\"{}/>\n", path,
                       line.closed ? "Z" : "", line.colour[0], line.colour[1], line.colour[2], line.width,
                       line.dashed ? " stroke-dasharray=\"1 0.7\"" : "");
}

std::string page_content(const Drawing& drawing) {
    std::string out;
    const auto to = std::back_inserter(out);
    const auto colour = [&](const Rgb& c, const char* name) {
        fmt::format_to(to, "{:.3f} {:.3f} {:.3f} {}\n", c[0] / 255.0, c[1] / 255.0, c[2] / 255.0, name);
    };
    // The page is in millimetres with y downwards; text is mirrored back.
    fmt::format_to(to, "{0:.6f} 0 0 -{0:.6f} 0 {1:.4f} cm\n1 j 1 J\nq\n", points_per_mm,
                   points_per_mm * drawing.size.y);
    const Vec2 clip{drawing.clip_hi.x - drawing.clip_lo.x, drawing.clip_hi.y - drawing.clip_lo.y};
    fmt::format_to(to, "{:.3f} {:.3f} {:.3f} {:.3f} re W n\n", drawing.clip_lo.x, drawing.clip_lo.y, clip.x, clip.y);
    for (const Drawing::Line& line : drawing.lines) {
        colour(line.colour, "RG");
        fmt::format_to(to, "{:.3f} w [{}] 0 d\n", line.width, line.dashed ? "1 0.7" : "");
        for (std::size_t i = 0; i < line.points.size(); ++i)
            fmt::format_to(to, "{:.3f} {:.3f} {}\n", line.points[i].x, line.points[i].y,
                           i == 0 || (line.pieces && i % 2 == 0) ? "m" : "l");
        out += line.closed ? "s\n" : "S\n";
    }
    out += "Q\n";
    for (const Drawing::Text& text : drawing.texts) {
        const double x = text.at.x - (text.centred ? width_of(text) / 2 : 0);
        const double y = text.at.y + middle_height * text.height;
        const auto show = [&](const char* mode) {
            fmt::format_to(to, "BT /F 1 Tf {} Tr {:.4f} 0 0 -{:.4f} {:.3f} {:.3f} Tm (", mode, text.height, text.height,
                           x, y);
            out += pdf_words(text.words) + ") Tj ET\n";
        };
        if (text.on_white) {
            fmt::format_to(to, "1 1 1 RG {:.3f} w [] 0 d\n", 0.3 * text.height);
            show("1");
        }
        colour(text.colour, "rg");
        show("0");
    }
    return out;
}

}  // namespace

std::string svg_of(const Drawing& d) {
    std::string out = fmt::format(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{0:.2f}mm\" height=\"{1:.2f}mm\" viewBox=\"0 0 {0:.2f} "
        "{1:.2f}\">\n<rect width=\"100%\" height=\"100%\" fill=\"#fff\"/>\n<clipPath id=\"inside\"><rect x=\"{2:.2f}\" "
        "y=\"{3:.2f}\" width=\"{4:.2f}\" height=\"{5:.2f}\"/></clipPath>\n<g clip-path=\"url(#inside)\" "
        "stroke-linejoin=\"round\" stroke-linecap=\"round\">\n",
        d.size.x, d.size.y, d.clip_lo.x, d.clip_lo.y, d.clip_hi.x - d.clip_lo.x, d.clip_hi.y - d.clip_lo.y);
    for (const Drawing::Line& line : d.lines) add_line(line, out);
    out += "</g>\n<g font-family=\"Helvetica, Arial, sans-serif\">\n";
    for (const Drawing::Text& text : d.texts)
        out += fmt::format(
            "<text x=\"{:.2f}\" y=\"{:.2f}\" font-size=\"{:.2f}\" fill=\"rgb({},{},{})\"{}{}>{}</text>\n", text.at.x,
            text.at.y + middle_height * text.height, text.height, text.colour[0], text.colour[1], text.colour[2],
            text.centred ? " text-anchor=\"middle\"" : "",
            text.on_white
                ? fmt::format(" paint-order=\"stroke\" stroke=\"#fff\" stroke-width=\"{:.2f}\"", 0.3 * text.height)
                : "",
            escaped(text.words));
    return out + "</g>\n</svg>\n";
}

std::string pdf_of(const Drawing& drawing) {
    const std::string content = page_content(drawing);
    const std::vector<std::string> objects{
        "<< /Type /Catalog /Pages 2 0 R >>", "<< /Type /Pages /Kids [3 0 R] /Count 1 >>",
        fmt::format("<< /Type /Page /Parent 2 0 R /MediaBox [0 0 {:.3f} {:.3f}] /Contents 4 0 R /Resources << /Font << "
                    "/F 5 0 R >> >> >>",
                    points_per_mm * drawing.size.x, points_per_mm * drawing.size.y),
        fmt::format("<< /Length {} >>\nstream\n{}endstream", content.size(), content),
        "<< /Type /Font /Subtype /Type1 /BaseFont /Helvetica /Encoding /WinAnsiEncoding >>"};
    std::string out = "%PDF-1.4\n%\xe2\xe3\xcf\xd3\n", table;
    for (std::size_t i = 0; i < objects.size(); ++i) {
        table += fmt::format("{:010} 00000 n \n", out.size());
        out += fmt::format("{} 0 obj\n{}\nendobj\n", i + 1, objects[i]);
    }
    const std::size_t at = out.size();
    return out + fmt::format(
                     "xref\n0 {0}\n0000000000 65535 f \n{1}trailer\n<< /Size {0} /Root 1 0 R >>\nstartxref\n{2}\n"
                     "%%EOF\n",
                     objects.size() + 1, table, at);
}

}  // namespace exitance
