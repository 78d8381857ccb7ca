#include "exitance/io/report/report_pdf.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <filesystem>
#include <vector>

#include "exitance/io/files/child_process.hpp"

namespace exitance {
namespace {

/// The first installed program that prints pages; empty if there is none.
std::string page_printer() {
    constexpr std::array<const char*, 4> known{"chromium", "chromium-browser", "google-chrome", "chrome"};
    const auto found = std::find_if(known.begin(), known.end(), [](const char* name) { return is_program(name); });
    return found == known.end() ? "" : *found;
}

}  // namespace

Result<void> find_page_printer(const std::string& path) {
    if (!page_printer().empty()) return {};
    return Error{ErrorCode::cannot_write, "a PDF is printed by Chromium, which is not installed", path,
                 "install the package chromium, or print the page from a browser"};
}

Result<void> print_page(const std::string& page, const std::string& path, const StopRequest& stop) {
    constexpr double max_seconds = 120;  // printing a page takes a few seconds; the limit ends a browser that hangs
    const auto words_for = [&](const std::string& part) {
        std::vector<std::string> words{page_printer(), "--headless", "--disable-gpu", "--no-pdf-header-footer",
                                       "--print-to-pdf=" + part};
        if (geteuid() == 0) words.push_back("--no-sandbox");  // Chromium has none for root
        words.push_back("file://" + std::filesystem::absolute(page).string());
        return words;
    };
    const Result<void> printed = run_into_file(path, words_for, max_seconds, stop);
    if (printed) return {};
    return Error{ErrorCode::cannot_write, fmt::format("the browser printed no PDF: {:.200}", printed.error().message),
                 path, "the page itself is written; print it from a browser"};
}

}  // namespace exitance
