#include "exitance/io/solution/solution_groups.hpp"

namespace exitance {

void write_links(Hdf5Writer& file, const std::string& group, const KeptLinks& links,
                 const Field<RegionId, Region>& regions) {
    std::vector<std::uint32_t> receiver, source;
    std::vector<float> form_factor;
    for (const KeptLink& link : links.links) {
        receiver.push_back(link.receiver.value);
        source.push_back(link.source.value);
        form_factor.push_back(link.form_factor);
    }
    file.make_group(group);
    write_function(file, group + "/elements", links.elements, regions);
    file.write(group + "/receiver", receiver, 1, {"1", "element that a link leads to"});
    file.write(group + "/source", source, 1, {"1", "element that it comes from"});
    file.write(group + "/form_factor", form_factor, 1,
               {"1", "from the receiver to the source, visibility included, mean over the receiver"});
}

KeptLinks read_links(Hdf5Reader& file, const std::string& group, const Field<RegionId, Region>& regions) {
    KeptLinks out;
    out.elements = read_function(file, group + "/elements", regions);
    const auto receiver = file.read<std::uint32_t>(group + "/receiver");
    const auto source = file.read<std::uint32_t>(group + "/source", 1, receiver.size());
    const auto form_factor = file.read<float>(group + "/form_factor", 1, receiver.size());
    if (file.failed()) return {};
    for (std::size_t i = 0; i < receiver.size(); ++i) {
        if (std::max(receiver[i], source[i]) >= out.elements.tree.size())
            return file.fail(group + "/receiver", "refers to an element that does not exist"), KeptLinks();
        out.links.push_back({ElementId(receiver[i]), ElementId(source[i]), form_factor[i]});
    }
    return out;
}

}  // namespace exitance
