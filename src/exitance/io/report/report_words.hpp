#pragma once

#include <map>
#include <string>
#include <vector>

#include "exitance/base/result.hpp"

namespace exitance {

/// Words of a report in another language, and the order of its sections.
class ReportWords {
  public:
    /// English, all sections in the usual order.
    ReportWords() = default;

    /// Loads a template: "german", or a TOML file
    ///
    ///     language = "de"                  # of the page's element html
    ///     decimal_comma = true             # 0,5 in place of 0.5
    ///     sections = ["pictures", "rooms"] # these alone, in this order; omitted: all
    ///     [words]
    ///     "Energy balance" = "Energiebilanz"
    ///     "{} smaller surfaces are not listed." = "{} kleinere Flächen sind nicht aufgeführt."
    ///
    /// A {} stands for a number or a name. Errors: a file that cannot be read, unknown keys and sections, a translation
    /// with another number of {}.
    static Result<ReportWords> load(const std::string& name_or_path);

    /// Ids of the sections in order; empty: all in the usual order.
    const std::vector<std::string>& sections() const { return sections_; }
    const std::string& language() const { return language_; }
    /// True if texts or numbers change.
    bool translates() const { return !exact_.empty() || !patterns_.empty() || decimal_comma_; }

    /// Translates one text of a page. A text without an entry stays as it is, but for decimal commas if it is a number.
    std::string text(const std::string& english) const;

    /// Translates the texts between the tags of an HTML page, and the attributes `alt` and `aria-label`. Scripts and
    /// styles stay.
    std::string page(const std::string& html) const;

  private:
    static Result<ReportWords> parse(const std::string& text, const std::string& file);
    std::string number(const std::string& text) const;

    struct Pattern {
        std::vector<std::string> pieces, translated;  ///< Texts around the {}, equally many in both.
    };
    std::string language_ = "en";
    bool decimal_comma_ = false;
    std::vector<std::string> sections_;
    std::map<std::string, std::string> exact_;
    std::vector<Pattern> patterns_;  ///< In the order of their lengths, the longest first.
};

/// The TOML of a known template, from which users make others; empty if there is none of that name.
std::string known_report_words(const std::string& name);

}  // namespace exitance
