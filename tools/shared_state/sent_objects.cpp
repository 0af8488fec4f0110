#include "sent_objects.hpp"

#include <algorithm>
#include <regex>

namespace shared_state {

namespace {

// A name in the arguments, with the members that follow it, and what is done with it.
struct Mention {
    std::string text;  // "mydata->states[].part"
    bool by_address = false;
    bool by_size = false;
    int dereferenced = 0;
};

std::string replaced(std::string text, std::regex const& what, char const* replacement) {
    for (std::string before; before != text;) {
        before = text;
        text = std::regex_replace(text, what, replacement);
    }
    return text;
}

// Without what does not tell what is sent: texts, indices, arguments of other functions, "struct", "swarm::".
std::string without_details(std::string text) {
    static std::regex const texts(R"re("([^"\\]|\\.)*"|'([^'\\]|\\.)*')re");
    static std::regex const indices(R"(\s*\[[^\[\]]+\])");
    static std::regex const words(R"(\b(struct|union|class|const|volatile)\b|[A-Za-z_]\w*\s*::|\bthis\s*->)");
    static std::regex const calls(R"(\b(?!sizeof\b)[A-Za-z_]\w*\s*\([^()]*\))");
    text = std::regex_replace(text, texts, "");
    text = replaced(text, indices, "[]");
    return replaced(std::regex_replace(text, words, ""), calls, "");
}

// Where the last argument begins: the number of bytes.
std::size_t start_of_size(std::string const& arguments) {
    int depth = 0;
    for (std::size_t i = arguments.size(); i-- > 0;) {
        char const c = arguments[i];
        depth += (c == ')' || c == '}') - (c == '(' || c == '{');
        if (c == ',' && depth == 0) {
            return i;
        }
    }
    return arguments.size();
}

std::vector<Mention> mentions_in(std::string const& arguments) {
    static std::regex const mention(
        R"((sizeof\b[\s(]*)?(&\s*\(*)?((?:\*\s*)*)([A-Za-z_]\w*(?:\[\])*(?:\s*(?:\.|->)\s*[A-Za-z_]\w*(?:\[\])*)*))");
    std::string const text = without_details(arguments);
    auto const size = static_cast<std::ptrdiff_t>(start_of_size(text));
    std::vector<Mention> found;
    for (std::sregex_iterator match(text.begin(), text.end(), mention), end; match != end; ++match) {
        Mention const one{.text = std::regex_replace(match->str(4), std::regex(R"(\s+)"), ""),
                          .by_address = (*match)[2].matched,
                          .by_size = (*match)[1].matched,
                          .dereferenced = static_cast<int>(std::count((*match)[3].first, (*match)[3].second, '*'))};
        if (one.by_size || match->position() < size) {
            found.push_back(one);
        }
    }
    return found;
}

bool is_one_byte(Basic& basic) {
    return !is_structure(&basic.type) && dwarf_bytesize(&basic.type) <= 1;
}

std::optional<SentObject> object_of(Mention const& mention, Place const& place, Declarations& declarations) {
    auto found = declarations.meant_by(mention.text, place);
    if (!found) {
        return std::nullopt;
    }
    auto type = found->type;
    for (int i = 0; i < mention.dereferenced; i++) {
        type = element(type);
    }
    auto bare = unnamed(type);
    if (!bare || (!is_variable(&found->entry) && !mention.by_size)) {
        return std::nullopt;
    }
    bool const has_address = is_pointer(&*bare) || is_array(&*bare);
    SentObject object{.name = mention.text, .declaration = found->entry};
    if (!mention.by_address && is_pointer(&*bare)) {
        object.is_size_of_address = mention.by_size;
        type = mention.by_size ? bare : type_of(&*bare);
    } else if (!mention.by_address && !mention.by_size && !is_array(&*bare)) {
        return std::nullopt;  // an offset
    } else if (!has_address && is_pointer(&*type)) {
        type = bare;  // a reference
    }
    auto basic = basic_type(type, /*through_pointers=*/false);
    if (!basic) {
        return std::nullopt;
    }
    object.type = *basic;
    object.is_buffer = !object.is_size_of_address && has_address && is_one_byte(object.type);
    return object;
}

}  // namespace

std::vector<SentObject> sent_objects(std::string const& arguments, Place const& place, Declarations& declarations) {
    auto const mentions = mentions_in(arguments);
    auto const is_sent_itself = [&](SentObject const& object) {
        return std::any_of(mentions.begin(), mentions.end(),
                           [&](Mention const& one) { return one.by_address && one.text == object.name; });
    };
    std::vector<SentObject> found;
    for (auto const& mention : mentions) {
        auto const object = object_of(mention, place, declarations);
        if (object && !(object->is_size_of_address && is_sent_itself(*object))) {
            found.push_back(*object);
        }
    }
    return found;
}

}  // namespace shared_state
