#include "exitance/cli/view/view_share.hpp"

#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "exitance/io/files/base64.hpp"
#include "exitance/io/files/whole_file.hpp"

namespace exitance {
namespace {

/// Escapes text for a script element, so that it cannot contain a closing tag.
std::string embedded(std::string text) {
    for (std::size_t at = 0; (at = text.find("</", at)) != std::string::npos; at += 3) text.replace(at, 2, "<\\/");
    return text;
}

/// Replaces the first tag from `begin` to `end` by an element with the content of the file that its attribute names.
Result<void> embed(std::string& page, const std::string& folder, const std::string& begin, const std::string& attribute,
                   const std::string& end, const std::string& element) {
    const std::size_t from = page.find(begin), to = from == std::string::npos ? from : page.find(end, from);
    const std::size_t name = from == std::string::npos ? from : page.find(attribute, from);
    if (to == std::string::npos || name >= to)
        return Error{ErrorCode::failure, "the viewer's page has no " + begin, folder, "build exitance again"};
    const std::size_t first = name + attribute.size();
    Result<std::string> text = read_whole_file(folder + "/" + page.substr(first, page.find('"', first) - first));
    if (!text) return text.error();
    const bool is_script = element.starts_with("<script");
    page.replace(from, to + end.size() - from,
                 element + (is_script ? embedded(std::move(*text)) : *text) + (is_script ? "</script>" : "</style>"));
    return {};
}

}  // namespace

Result<std::string> make_shared_page(const std::string& folder, const SharedPage& content) {
    Result<std::string> page = read_whole_file(folder + "/index.html");
    if (!page) return page;
    std::string parts;
    for (const std::string& part : content.parts)
        parts += fmt::format("{}\"{}\"", parts.empty() ? "" : ",", base64(std::as_bytes(std::span(part))));
    const std::string data = fmt::format(R"({{"state":null,"views":{},"scene":{},"parts":[{}]}})",
                                         embedded(content.views), embedded(content.scene), parts);
    const Result<void> script =
        embed(*page, folder, "<script type=\"module\"", "src=\"/", "</script>",
              "<script type=\"application/json\" id=\"shared\">" + data + "</script>\n<script type=\"module\">");
    if (!script) return script.error();
    const Result<void> styles = embed(*page, folder, "<link rel=\"stylesheet\"", "href=\"/", ">", "<style>");
    if (!styles) return styles.error();
    return page;
}

Result<std::string> read_saved_views(const std::string& path) {
    const Result<std::string> text = read_whole_file(path);
    if (!text) return text;
    const nlohmann::json views = nlohmann::json::parse(*text, nullptr, false);
    bool is_good = views.is_array() && !views.empty();
    if (is_good)
        for (const nlohmann::json& view : views)
            is_good = is_good && view.is_object() && view.contains("name") && view["name"].is_string() &&
                      view.contains("camera") && view["camera"].is_string();
    if (!is_good)
        return Error{ErrorCode::bad_input, "holds no saved views", path,
                     "save views in the viewer's page: Views, Save as file"};
    return views.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
}

}  // namespace exitance
