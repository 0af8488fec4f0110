// Memory for the rows of tables.
#pragma once

#include <arrow/memory_pool.h>

namespace pogosim {

/// The C library's memory. It keeps large pieces for reuse, where other pools give them back to the system, which
/// clears each page before it is used again.
inline arrow::MemoryPool* table_memory() {
    return arrow::system_memory_pool();
}

}  // namespace pogosim
