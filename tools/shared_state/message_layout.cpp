#include "message_layout.hpp"

#include <dwarf.h>

#include <algorithm>
#include <cctype>
#include <map>
#include <set>
#include <string_view>
#include <tuple>

#include "debug_info/debug_info.hpp"
#include "sent_objects.hpp"
#include "types.hpp"

namespace shared_state {

namespace {

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
    bool const is_of_long = base == "long int" || base == "long unsigned int" || base == "long" ||
                            base == "unsigned long" || base == "long double";
    return is_of_long && std::none_of(basic.names.begin(), basic.names.end(), has_64_bits);
}

bool is_odd(Basic& basic) {
    return is_pointer(&basic.type) || is_long(basic);
}

class Finder {
public:
    explicit Finder(ProgramFile const& program) : program_(program) {
        Dwarf_CU* unit = nullptr;
        Dwarf_CU* next = nullptr;
        Dwarf_Die entry;
        while (dwarf_get_units(program.debug_info(), unit, &next, nullptr, nullptr, &entry, nullptr) == 0) {
            look_at(entry, /*receives=*/false);
            unit = next;
        }
    }

    std::vector<OddMember> find() {
        for (auto& [offset, type] : received_) {
            if (!of_user_data_.empty() && !of_user_data_.contains(offset)) {
                messages_.emplace(offset, type);
            }
        }
        for (auto& [offset, message] : messages_) {
            look_at_members(message.name, message.type);
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
    };

    void look_at(Dwarf_Die entry, bool receives) {
        switch (dwarf_tag(&entry)) {
            case DW_TAG_subprogram:
                receives = takes_message(entry);
                break;
            case DW_TAG_variable:
                look_at_variable(entry, receives);
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
        for_each_child(&entry, [&](Dwarf_Die child) { look_at(child, receives); });
    }

    static bool takes_message(Dwarf_Die& function) {
        bool found = false;
        for_each_child(&function, [&](Dwarf_Die child) {
            if (dwarf_tag(&child) == DW_TAG_formal_parameter) {
                auto const basic = basic_type(type_of(&child), /*through_pointers=*/true);
                found = found || (basic && std::find(basic->names.begin(), basic->names.end(), "message_t") !=
                                               basic->names.end());
            }
        });
        return found;
    }

    void look_at_variable(Dwarf_Die& variable, bool receives) {
        if (is_note_of_sending(&variable)) {
            for (auto& sent : sent_objects(&variable, program_)) {
                look_at_sent(sent);
            }
            return;
        }
        auto basic = basic_type(type_of(&variable), /*through_pointers=*/true);
        if (!basic || !is_structure(&basic->type)) {
            return;
        }
        if (name_of(&variable) == "mydata") {
            note_user_data(basic->type);
        } else if (receives) {
            received_.emplace(dwarf_dieoffset(&basic->type), Message{name_of(*basic), basic->type});
        }
    }

    void look_at_sent(SentObject& sent) {
        std::string const name = name_of(sent.type);
        if (is_structure(&sent.type.type)) {
            messages_.emplace(dwarf_dieoffset(&sent.type.type),
                              Message{name.empty() ? sent.name : name, sent.type.type});
        } else if (is_odd(sent.type)) {
            note("", sent.declaration, sent.type);
        }
    }

    void look_at_name(Dwarf_Die& entry) {
        auto basic = basic_type(entry, /*through_pointers=*/false);
        std::string const name = name_of(&entry);
        if (!basic || !is_structure(&basic->type)) {
            return;
        }
        if (sounds_like_a_message(name)) {
            messages_.emplace(dwarf_dieoffset(&basic->type), Message{name, basic->type});
        }
    }

    void note_user_data(Dwarf_Die& type) {
        if (!of_user_data_.insert(dwarf_dieoffset(&type)).second) {
            return;
        }
        for_each_child(&type, [&](Dwarf_Die member) {
            auto basic = basic_type(type_of(&member), /*through_pointers=*/true);
            if (basic && is_structure(&basic->type)) {
                note_user_data(basic->type);
            }
        });
    }

    void look_at_members(std::string const& message, Dwarf_Die& type) {
        for_each_child(&type, [&](Dwarf_Die member) {
            auto basic = basic_type(type_of(&member), /*through_pointers=*/false);
            if (dwarf_tag(&member) != DW_TAG_member || !basic) {
                return;
            }
            if (is_structure(&basic->type)) {
                look_at_members(message, basic->type);
            } else if (is_odd(*basic)) {
                note(message, member, *basic);
            }
        });
    }

    void note(std::string const& message, Dwarf_Die& member, Basic& basic) {
        OddMember odd{.message = message, .name = name_of(&member), .file = file_of(&member)};
        if (!is_pointer(&basic.type)) {
            odd.type = name_of(basic);
        }
        odd.bytes = static_cast<uint64_t>(std::max(0, dwarf_bytesize(&basic.type)));
        dwarf_decl_line(&member, &odd.line);
        dwarf_decl_column(&member, &odd.column);
        found_.push_back(odd);
    }

    ProgramFile const& program_;
    std::map<Dwarf_Off, Message> messages_;
    std::map<Dwarf_Off, Message> received_;
    std::set<Dwarf_Off> of_user_data_;
    std::vector<OddMember> found_;
};

}  // namespace

std::vector<OddMember> odd_members_of_messages(ProgramFile const& program) {
    return Finder(program).find();
}

}  // namespace shared_state
