// What a process keeps of results that it may need again: those that were used last.
#pragma once

#include <cstddef>
#include <list>
#include <memory>
#include <mutex>
#include <utility>

namespace pogosim {

/// May be used by several threads.
template <class Entry>
class Recent {
public:
    explicit Recent(std::size_t most) : most_(most) {}

    /// The entry for which a condition holds, which is then the one that was used last; null: there is none.
    template <class Condition>
    std::shared_ptr<Entry const> find(Condition const& is_meant) {
        std::lock_guard const lock(mutex_);
        for (auto entry = entries_.begin(); entry != entries_.end(); ++entry) {
            if (is_meant(**entry)) {
                entries_.splice(entries_.begin(), entries_, entry);
                return entries_.front();
            }
        }
        return nullptr;
    }

    /// Keeps an entry, in place of those for which a condition holds.
    template <class Condition>
    void keep(std::shared_ptr<Entry const> kept, Condition const& is_replaced) {
        std::lock_guard const lock(mutex_);
        std::erase_if(entries_, [&](auto const& entry) { return is_replaced(*entry); });
        entries_.push_front(std::move(kept));
        if (entries_.size() > most_) {
            entries_.pop_back();
        }
    }

private:
    std::size_t most_;
    std::mutex mutex_;                                 // of what follows
    std::list<std::shared_ptr<Entry const>> entries_;  // the one that was used last comes first
};

}  // namespace pogosim
