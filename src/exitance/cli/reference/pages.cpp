#include "exitance/cli/reference/pages.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <functional>
#include <sstream>

#include "exitance/methods/options/recipes.hpp"

namespace exitance {
namespace {

constexpr std::size_t line_width = 100, help_column = 30;

/// Names and type of an option, such as "-o, --output FILE".
std::string spelling(const OptionFacts& option) {
    if (option.is_input()) return option.type;
    std::string out = option.short_name;
    if (!option.long_name.empty()) out += (out.empty() ? "" : ", ") + option.long_name;
    return option.type.empty() ? out : out + " " + option.type;
}

/// `text` in lines of at most `width` characters, the second and later ones indented.
std::string wrapped(const std::string& text, std::size_t width, std::size_t indent) {
    std::istringstream in(text);
    std::string out;
    std::size_t used = 0;
    for (std::string word; in >> word;) {
        const bool breaks = used > 0 && used + 1 + word.size() > width;
        if (breaks) out += '\n' + std::string(indent, ' '), used = 0;
        if (used > 0) out += ' ', ++used;
        out += word, used += word.size();
    }
    return out;
}

/// Groups of a verb's options in the order of the pages: first those that option_groups does not list, in order of
/// occurrence, then those of option_groups. Inputs belong to no group.
std::vector<std::string> groups_of(const VerbFacts& verb) {
    std::vector<std::string> out;
    const auto add = [&](const std::string& group) {
        const bool is_used = std::any_of(verb.options.begin(), verb.options.end(),
                                         [&](const OptionFacts& o) { return o.group == group && !o.is_input(); });
        if (is_used && std::find(out.begin(), out.end(), group) == out.end()) out.push_back(group);
    };
    const auto is_known = [](const std::string& group) {
        return std::any_of(std::begin(option_groups::all), std::end(option_groups::all),
                           [&](const OptionGroup& g) { return g.title == group; });
    };
    for (const OptionFacts& option : verb.options)
        if (!is_known(option.group)) add(option.group);
    for (const OptionGroup& group : option_groups::all) add(std::string(group.title));
    return out;
}

std::string usage_line(const VerbFacts& verb) {
    std::string out = "exitance " + verb.name + " [options]";
    for (const OptionFacts& option : verb.options)
        if (option.is_input()) out += option.is_required ? " " + option.type : " [" + option.type + "]";
    return out;
}

void add_help(std::string& out, const OptionFacts& option, bool all) {
    const std::string left = "  " + spelling(option);
    out += left;
    out += left.size() + 2 <= help_column ? std::string(help_column - left.size(), ' ')
                                          : "\n" + std::string(help_column, ' ');
    std::string help = option.help;
    if (all && !option.supported_by.empty()) help += fmt::format(" Supported by {}.", option.supported_by);
    out += wrapped(help, line_width - help_column, help_column) + "\n";
}

std::string recipe_list() {
    std::string out = "\nRecipes (--recipe NAME):\n";
    for (const Recipe& recipe : recipes()) {
        out += fmt::format("  {:<26}  ", recipe.name);
        const std::string source = recipe.source.empty() ? "" : fmt::format(" [{}]", recipe.source);
        out += wrapped(fmt::format("{}{}: {}", recipe.does, source, recipe.presets), line_width - help_column,
                       help_column);
        out += '\n';
    }
    return out;
}

// -------------------------------------------------------------------------------------------------- Markdown

/// Text escaped for a cell of a Markdown table.
std::string cell(const std::string& text) {
    std::string out;
    for (const char c : text) {
        if (c == '|') out += '\\';
        out += c == '<' ? std::string("&lt;") : std::string(1, c);
    }
    return out;
}

constexpr const char* markdown_head = R"(# Options
All verbs and their options. This page is printed by `exitance reference --format markdown > docs/options.md`; a test compares
them. `exitance VERB --help` lists the options for users, `--help-all` those of all groups.

An option that the chosen method does not support is a usage error (status 2), which names the methods that do. `--method auto`
takes a method that supports all options. *Published* means a method in the form of its paper ([recipes](laboratory/recipes.md)).
)";

std::string markdown_recipes() {
    std::string out = "\n### Recipes\n| `--recipe` | reproduces | presets |\n|---|---|---|\n";
    for (const Recipe& recipe : recipes())
        out += fmt::format("| `{}` | {}{} | `{}` |\n", recipe.name, recipe.does,
                           recipe.source.empty() ? "" : fmt::format(" [{}]", recipe.source),
                           cell(std::string(recipe.presets)));
    return out;
}

// ------------------------------------------------------------------------------------------------------ man

/// Text with roff's special characters escaped.
std::string roff(const std::string& text) {
    std::string out;
    for (const char c : text) {
        if (c == '\\' || c == '-') out += '\\';
        out += c;
    }
    return out.starts_with('.') || out.starts_with('\'') ? "\\&" + out : out;
}

// ---------------------------------------------------------------------------------------------- completion

/// The words of a type such as "on|off"; empty if some are placeholders, which are in capitals.
std::vector<std::string> words_of(const std::string& type) {
    std::vector<std::string> words;
    std::istringstream in(type);
    for (std::string word; std::getline(in, word, '|');)
        if (!word.empty() && std::none_of(word.begin(), word.end(), [](char c) { return c >= 'A' && c <= 'Z'; }))
            words.push_back(word);
    return words;
}

std::vector<std::string> names_of_options(const VerbFacts& verb) {
    std::vector<std::string> names;
    for (const OptionFacts& option : verb.options)
        if (!option.long_name.empty() && option.audience != Audience::old_names) names.push_back(option.long_name);
    return names;
}

std::vector<std::string> values_of(const OptionFacts& option) {
    if (option.long_name != "--recipe") return words_of(option.type);
    std::vector<std::string> names;
    for (const Recipe& recipe : recipes()) names.emplace_back(recipe.name);
    return names;
}

/// Text escaped for '[...]' in a specification of zsh's _arguments.
std::string zsh_text(const std::string& text) {
    std::string out;
    for (const char c : text) {
        if (c == '[' || c == ']' || c == ':' || c == '\\') out += '\\';
        out += c == '\'' ? std::string("'\\''") : std::string(1, c);
    }
    return out;
}

std::string zsh_action(const OptionFacts& option) {
    const std::vector<std::string> values = values_of(option);
    if (!values.empty()) return fmt::format("({})", fmt::join(values, " "));
    return option.type == "FILE" || option.is_input() ? "_files" : option.type == "FOLDER" ? "_files -/" : "";
}

}  // namespace

std::string help_page(const VerbFacts& verb, bool all) {
    std::string out = fmt::format("Example:\n  {}\n\n{}\n\nUsage: {}\n", verb.example, verb.does, usage_line(verb));
    bool has_inputs = false, hides = false, has_recipes = false;
    for (const OptionFacts& option : verb.options) {
        if (!option.is_input()) continue;
        if (!has_inputs) out += "\nInput:\n", has_inputs = true;
        add_help(out, option, all);
    }
    for (const std::string& group : groups_of(verb)) {
        std::string lines;
        for (const OptionFacts& option : verb.options) {
            if (option.group != group || option.is_input()) continue;
            const bool is_shown = all || option.audience == Audience::users;
            hides = hides || !is_shown, has_recipes = has_recipes || option.long_name == "--recipe";
            if (is_shown) add_help(lines, option, all);
        }
        if (!lines.empty()) out += fmt::format("\n{}:\n{}", group, lines);
    }
    if (all && has_recipes) out += recipe_list();
    if (hides)
        out += fmt::format("\nexitance {} --help-all also lists options for experts{}.\n", verb.name,
                           has_recipes ? ", and for reproducing published methods" : "");
    return out;
}

std::string markdown_page(std::span<const VerbFacts> verbs) {
    std::string out = markdown_head;
    for (const VerbFacts& verb : verbs) {
        out += fmt::format("\n## {}\n{}\n\n    {}\n", verb.name, verb.does, verb.example);
        const auto table = [&](const std::string& title, const std::function<bool(const OptionFacts&)>& belongs) {
            const bool by_method = std::any_of(verb.options.begin(), verb.options.end(), [&](const OptionFacts& o) {
                return belongs(o) && !o.supported_by.empty();
            });
            out += fmt::format("\n### {}\n| option | does |{}\n|---|---|{}\n", title,
                               by_method ? " supported by |" : "", by_method ? "---|" : "");
            for (const OptionFacts& option : verb.options) {
                if (!belongs(option)) continue;
                out += fmt::format("| `{}` | {} |", cell(spelling(option)), cell(option.help));
                if (by_method) out += fmt::format(" {} |", option.supported_by.empty() ? "all" : option.supported_by);
                out += '\n';
            }
        };
        if (std::any_of(verb.options.begin(), verb.options.end(), [](const OptionFacts& o) { return o.is_input(); }))
            table("Input", [](const OptionFacts& o) { return o.is_input(); });
        bool has_recipes = false;
        for (const std::string& group : groups_of(verb))
            table(group, [&](const OptionFacts& o) {
                has_recipes = has_recipes || o.long_name == "--recipe";
                return o.group == group && !o.is_input();
            });
        if (has_recipes) out += markdown_recipes();
    }
    return out;
}

std::string man_page(std::span<const VerbFacts> verbs, const std::string& version) {
    std::string out = fmt::format(
        ".TH EXITANCE 1 \"\" \"exitance {}\"\n.SH NAME\nexitance \\- light in scenes of diffuse surfaces\n"
        ".SH SYNOPSIS\n.B exitance\n.I VERB\n[options]\n.I INPUT...\n.SH EXIT STATUS\n"
        "0 done; 1 failure; 2 usage; 3 bad input; 4 a result was written but the requested error was not reached; 5 no "
        "result; "
        "130 and 143 after a signal.\n",
        version);
    for (const VerbFacts& verb : verbs) {
        out += fmt::format(".SH {}\n{}\n.PP\n.nf\n{}\n.fi\n", verb.name, roff(verb.does), roff(verb.example));
        const auto list = [&](const OptionFacts& option) {
            out += fmt::format(".TP\n\\fB{}\\fR\n{}\n", roff(spelling(option)), roff(option.help));
            if (!option.supported_by.empty()) out += roff(fmt::format("Supported by {}.", option.supported_by)) + "\n";
        };
        for (const OptionFacts& option : verb.options)
            if (option.is_input()) list(option);
        for (const std::string& group : groups_of(verb)) {
            out += fmt::format(".SS {}: {}\n", verb.name, group);
            for (const OptionFacts& option : verb.options)
                if (option.group == group && !option.is_input()) list(option);
        }
    }
    return out;
}

std::string bash_completion(std::span<const VerbFacts> verbs) {
    std::vector<std::string> names;
    std::string cases, values;
    for (const VerbFacts& verb : verbs) {
        names.push_back(verb.name);
        cases += fmt::format("        {}) words='{}' ;;\n", verb.name, fmt::join(names_of_options(verb), " "));
        for (const OptionFacts& option : verb.options)
            if (const auto words = values_of(option); !words.empty() && option.audience != Audience::old_names)
                values +=
                    fmt::format("        {}:{}) values='{}' ;;\n", verb.name, option.long_name, fmt::join(words, " "));
    }
    return fmt::format(
        "# Completion of exitance for bash, made by: exitance reference --format bash\n"
        "_exitance() {{\n"
        "    local word=${{COMP_WORDS[COMP_CWORD]}} verb=${{COMP_WORDS[1]}} words= values=\n"
        "    if [[ $COMP_CWORD -eq 1 ]]; then\n"
        "        COMPREPLY=($(compgen -W '{} --help --version' -- \"$word\"))\n"
        "        return\n"
        "    fi\n"
        "    case $verb in\n{}    esac\n"
        "    case $verb:${{COMP_WORDS[COMP_CWORD-1]}} in\n{}    esac\n"
        "    COMPREPLY=()\n"
        "    if [[ -n $values ]]; then\n"
        "        COMPREPLY=($(compgen -W \"$values\" -- \"$word\"))\n"
        "    elif [[ $word == -* ]]; then\n"
        "        COMPREPLY=($(compgen -W \"$words\" -- \"$word\"))\n"
        "    fi\n"
        "}}\n"
        "complete -o default -F _exitance exitance\n",
        fmt::join(names, " "), cases, values);
}

std::string zsh_completion(std::span<const VerbFacts> verbs) {
    std::string out =
        "#compdef exitance\n# Completion of exitance for zsh, made by: exitance reference --format zsh\n"
        "_exitance() {\n    if (( CURRENT == 2 )); then\n        local -a verbs=(\n";
    for (const VerbFacts& verb : verbs) out += fmt::format("            '{}:{}'\n", verb.name, zsh_text(verb.does));
    out +=
        "        )\n        _describe verb verbs\n        return\n    fi\n    local verb=$words[2]\n"
        "    shift words; (( CURRENT-- ))\n    case $verb in\n";
    for (const VerbFacts& verb : verbs) {
        out += fmt::format("        {})\n            _arguments \\\n", verb.name);
        for (const OptionFacts& option : verb.options) {
            if (option.long_name.empty() || option.audience == Audience::old_names) continue;
            out += fmt::format(
                "                '{}[{}]{}' \\\n", option.long_name, zsh_text(option.help),
                option.type.empty() ? "" : fmt::format(":{}:{}", zsh_text(option.type), zsh_action(option)));
        }
        out += "                '*:input:_files' ;;\n";
    }
    return out + "    esac\n}\n_exitance \"$@\"\n";
}

std::string option_list(std::span<const VerbFacts> verbs) {
    constexpr std::array<const char*, 4> audiences{"users", "experts", "laboratory", "old names"};
    std::string out;
    for (const VerbFacts& verb : verbs)
        for (const OptionFacts& option : verb.options)
            out += fmt::format("{}\t{}\t{}\t{}\t{}\n", verb.name,
                               !option.long_name.empty()    ? option.long_name
                               : !option.short_name.empty() ? option.short_name
                                                            : option.type,
                               option.type, option.group, audiences[static_cast<std::size_t>(option.audience)]);
    return out;
}

}  // namespace exitance
