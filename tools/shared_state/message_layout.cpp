#include "message_layout.hpp"

#include <dwarf.h>

#include <algorithm>
#include <cctype>
#include <fstream>
#include <iterator>
#include <map>
#include <set>
#include <string_view>
#include <tuple>

#include "debug_info/debug_info.hpp"
#include "debug_info/shared_variables.hpp"
#include "declarations.hpp"
#include "payloads.hpp"
#include "sent_objects.hpp"
#include "types.hpp"

namespace shared_state {

namespace {

using Oddity = OddMember::Oddity;

bool sounds_like_a_message(std::string name) {
    std::transform(name.begin(), name.end(), name.begin(), [](unsigned char c) { return std::tolower(c); });
    auto const words = {"message", "msg", "packet", "payload"};
    return std::any_of(words.begin(), words.end(),
                       [&](char const* word) { return name.find(word) != std::string::npos; });
}

// A type whose size is that of `long`, unless it is the name of one with 64 bits everywhere.
bool is_long(Basic& basic) {
    std::string const base = name_of(&basic.type);
    auto const has_64_bits = [](std::string const& name) {
        return name.find("64") != std::string::npos || name.find("intmax") != std::string::npos;
    };
    bool const is_of_long =
        base == "long int" || base == "long unsigned int" || base == "long" || base == "unsigned long";
    return is_of_long && std::none_of(basic.names.begin(), basic.names.end(), has_64_bits);
}

std::optional<Oddity> oddity_of(Basic& basic) {
    if (is_pointer(&basic.type)) {
        return Oddity::address;
    }
    if (name_of(&basic.type).find("long double") != std::string::npos) {
        return Oddity::other_format;
    }
    return is_long(basic) ? std::optional(Oddity::other_size) : std::nullopt;
}

class Finder {
public:
    Finder(ProgramFile const& program, std::vector<std::string> const& ignored_folders)
        : program_(program), ignored_folders_(ignored_folders), declarations_(program) {}

    std::vector<OddMember> find() {
        for_each_unit(program_.debug_info(), [&](Dwarf_Die& unit) {
            look_at(unit);
            look_at_files(unit);
        });
        if (!is_sending_known_) {
            for (auto& [offset, message] : named_like_messages_) {
                if (!of_user_data_.contains(offset)) {
                    messages_.emplace(offset, message);
                }
            }
        }
        for (auto& [offset, message] : messages_) {
            look_at_members(message.name, message.type, message.declaration);
        }
        auto const place = [](OddMember const& one) { return std::tie(one.file, one.line, one.column, one.name); };
        auto const is_before = [&](OddMember const& a, OddMember const& b) { return place(a) < place(b); };
        auto const is_same = [&](OddMember const& a, OddMember const& b) { return place(a) == place(b); };
        std::sort(found_.begin(), found_.end(), is_before);
        found_.erase(std::unique(found_.begin(), found_.end(), is_same), found_.end());
        return found_;
    }

private:
    struct Message {
        std::string name;
        Dwarf_Die type;
        Dwarf_Die declaration;
    };

    void look_at(Dwarf_Die& entry) {
        switch (dwarf_tag(&entry)) {
            case DW_TAG_variable:
                look_at_variable(entry);
                return;
            case DW_TAG_typedef:
            case DW_TAG_structure_type:
            case DW_TAG_class_type:
            case DW_TAG_union_type:
                look_at_name(entry);
                break;
            default:
                break;
        }
        for_each_child(&entry, [&](Dwarf_Die& child) { look_at(child); });
    }

    void look_at_variable(Dwarf_Die& variable) {
        std::string const name = name_of(&variable);
        if (name == "pogosim_sent_arguments") {
            look_at_sending(variable);
        } else if (name == "pogo_user_data_type") {
            note_user_data(variable);
        }
    }

    // POGO_NOTE_SENT in infrared.h
    void look_at_sending(Dwarf_Die& note) {
        if (auto const address = address_of(&note)) {
            Place const place = place_of(note);
            for (auto& sent : sent_objects(program_.text_at(*address), place, declarations_)) {
                is_sending_known_ = is_sending_known_ || !(sent.is_buffer || sent.is_size_of_address);
                look_at_object(sent, place);
            }
        }
    }

    // Source files: debug information does not tell of casts.
    void look_at_files(Dwarf_Die& unit) {
        Dwarf_Files* files = nullptr;
        std::size_t count = 0;
        if (dwarf_getsrcfiles(&unit, &files, &count) != 0) {
            return;
        }
        for (std::size_t i = 0; i < count; i++) {
            std::string const file = path_in(&unit, dwarf_filesrc(files, i, nullptr, nullptr));
            if (!is_in_folders(file, ignored_folders_) && files_.insert(file).second) {
                look_at_file(file, unit);
            }
        }
    }

    void look_at_file(std::string const& file, Dwarf_Die& unit) {
        std::ifstream stream(file);
        for (auto const& use : payload_uses({std::istreambuf_iterator<char>(stream), {}})) {
            Place const place{.entry = unit, .file = file, .line = use.line};
            if (is_message(use.message, place)) {
                for (auto& object : sent_objects(use.arguments, place, declarations_)) {
                    look_at_object(object, place);
                }
            }
        }
    }

    bool is_message(std::string const& expression, Place const& place) {
        auto const found = declarations_.meant_by(expression, place);
        auto basic = basic_type(found ? found->type : std::nullopt, /*through_pointers=*/true);
        if (!basic) {
            return false;
        }
        auto const is_name = [](std::string const& name) { return name == "message_t" || name == "short_message_t"; };
        return is_name(name_of(&basic->type)) || std::any_of(basic->names.begin(), basic->names.end(), is_name);
    }

    void look_at_object(SentObject& object, Place const& place) {
        std::string const name = name_of(object.type);
        if (object.is_size_of_address) {
            note({.name = object.name, .oddity = Oddity::size_of_address}, place);
        } else if (is_structure(&object.type.type)) {
            messages_.emplace(dwarf_dieoffset(&object.type.type),
                              Message{name.empty() ? object.name : name, object.type.type, object.declaration});
        } else if (auto const oddity = oddity_of(object.type)) {
            note_member({.oddity = *oddity}, object.declaration, object.type);
        }
    }

    void look_at_name(Dwarf_Die& entry) {
        std::string const name = name_of(&entry);
        auto basic = basic_type(entry, /*through_pointers=*/false);
        if (basic && is_structure(&basic->type) && sounds_like_a_message(name)) {
            named_like_messages_.emplace(dwarf_dieoffset(&basic->type), Message{name, basic->type, basic->type});
        }
    }

    void note_user_data(Dwarf_Die& variable_or_member) {
        auto basic = basic_type(type_of(&variable_or_member), /*through_pointers=*/true);
        if (basic && is_structure(&basic->type) && of_user_data_.insert(dwarf_dieoffset(&basic->type)).second) {
            for_each_child(&basic->type, [&](Dwarf_Die& member) { note_user_data(member); });
        }
    }

    // `outer`: what contains the members as its user knows it.
    void look_at_members(std::string const& message, Dwarf_Die& type, Dwarf_Die& outer) {
        bool const is_of_library = is_in_folders(file_of(&type), ignored_folders_);
        for_each_child(&type, [&](Dwarf_Die& member) {
            int const tag = dwarf_tag(&member);
            auto basic = basic_type(type_of(&member), /*through_pointers=*/false);
            if ((tag != DW_TAG_member && tag != DW_TAG_inheritance) || !basic) {
                return;
            }
            auto const oddity = oddity_of(*basic);
            if (is_structure(&basic->type)) {
                bool const has_name = tag == DW_TAG_member && !is_of_library;
                look_at_members(message, basic->type, has_name ? member : outer);
            } else if (oddity && is_of_library) {
                note_member({.message = message, .oddity = *oddity, .is_inside = true}, outer, *basic);
            } else if (oddity && name_of(&member).starts_with("_vptr")) {
                std::string const name = name_of(&type);
                note({.message = name == message ? "" : message, .name = name, .oddity = Oddity::virtual_functions},
                     place_of(type));
            } else if (oddity) {
                note_member({.message = message, .oddity = *oddity}, member, *basic);
            }
        });
    }

    void note_member(OddMember odd, Dwarf_Die& member, Basic& basic) {
        odd.name = name_of(&member);
        odd.type = odd.is_inside ? name_of(&basic.type) : name_of(basic);
        odd.bytes = static_cast<uint64_t>(std::max(0, dwarf_bytesize(&basic.type)));
        dwarf_decl_column(&member, &odd.column);
        note(odd, place_of(member));
    }

    void note(OddMember odd, Place const& place) {
        if (!is_in_folders(place.file, ignored_folders_)) {
            odd.file = place.file;
            odd.line = place.line;
            found_.push_back(odd);
        }
    }

    ProgramFile const& program_;
    std::vector<std::string> const& ignored_folders_;
    Declarations declarations_;
    std::map<Dwarf_Off, Message> messages_;
    std::map<Dwarf_Off, Message> named_like_messages_;
    std::set<Dwarf_Off> of_user_data_;
    std::set<std::string> files_;
    bool is_sending_known_ = false;
    std::vector<OddMember> found_;
};

}  // namespace

std::vector<OddMember> odd_members_of_messages(ProgramFile const& program,
                                               std::vector<std::string> const& ignored_folders) {
    return Finder(program, ignored_folders).find();
}

}  // namespace shared_state
