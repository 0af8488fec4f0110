/// @file
/// The user's section of the flash memory: 5888 pages of 256 bytes (1.4 MiB) that a robot keeps while it is off, each
/// robot its own. Fresh pages are erased: all bytes are 0xFF. Like all that a robot remembers, pages start fresh in
/// each run; `flash_state` in the configuration keeps them from one run to the next.
#ifndef POGOSIM_POGOLIB_FLASH_H
#define POGOSIM_POGOLIB_FLASH_H

/// Where the section begins in the flash memory of a real robot, bytes.
#define POGOBOT_USER_FLASH_START_OFFSET 0x90000u
/// Bytes of a page.
#define POGOBOT_USER_FLASH_PAGE_SIZE 256u
/// Pages of the section.
#define POGOBOT_USER_FLASH_PAGE_COUNT 5888u

#ifdef __cplusplus
extern "C" {
#endif
POGO_BEGIN_API

/// Reads a page: POGOBOT_USER_FLASH_PAGE_SIZE bytes, to `buf`, not NULL. An unknown page leaves `buf` as it is.
/// @range page: 0 to 5887
void read_page_flash(uint16_t page, char buf[POGOBOT_USER_FLASH_PAGE_SIZE]);

/// Writes a page: POGOBOT_USER_FLASH_PAGE_SIZE bytes, from `data`, not NULL. An unknown page writes nothing. On a real
/// robot, a write only clears bits, so a page must be erased before it is written again. In the simulator, a write
/// replaces the page, unless `flash: nor` asks for the robot's way.
/// @range page: 0 to 5887
void write_page_flash(uint16_t page, const void* data);

/// Erases the whole section: all bytes are 0xFF.
void erase_write_section_flash(void);

POGO_END_API
#ifdef __cplusplus
}
#endif

#endif
