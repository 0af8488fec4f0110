# The firmware of a robot, for the Makefile's bin, emu and connect: all files of the project and Pogosim's interface
# layer, compiled and linked according to the Pogobot SDK.
#
# The SDK's tools/variables.mak and tools/common.mak define the compiler and its options (TRIPLE, CC, CFLAGS and the
# macro `compile`) and the robot's addresses (ROM_BASE). For emu, Pogosim's robot_tools.mk does, and other files beside
# it take the place of the SDK's headers, linker script and libraries.
ifeq ($(MAKECMDGOALS),emu)
TARGET := emu
# Names of files, in which make takes blanks for the ends of names.
EMU_FILES := $(subst \ ,?,$(POGOSIM_EMU_DIR))
include $(EMU_FILES)/robot_tools.mk
else
TARGET := bin
include $(POGO_SDK)/tools/variables.mak
include $(POGO_SDK)/tools/common.mak
endif

FIRMWARE_DIR := $(BUILD_DIR)/$(TARGET)
FIRMWARE := $(FIRMWARE_DIR)/firmware

.PHONY: bin emu connect

# ---- bin and emu

ifneq ($(words $(ROBOT_CATEGORY)),1)
$(error ROBOT_CATEGORY must be one word, found '$(ROBOT_CATEGORY)')
endif

# $(call names_in,FOLDER,ENDING): names of the files in a folder, in whose own name blanks are escaped.
names_in = $(sort $(filter %$(2),$(notdir $(wildcard $(1)/*$(2)))))
PROGRAM_OBJECTS := $(SOURCES:%=$(FIRMWARE_DIR)/%.o)
LAYER_OBJECTS := $(patsubst %,$(FIRMWARE_DIR)/pogosim/%.o,$(call names_in,$(POGOSIM_INTERFACE_DIR),.c))
UTILS_OBJECTS := $(patsubst %,$(FIRMWARE_DIR)/utils/%.o,$(notdir $(UTILS_SOURCES)))
OBJECTS := $(PROGRAM_OBJECTS) $(UTILS_OBJECTS) $(LAYER_OBJECTS)
# Whether the program uses the layer: one with pogobot.h alone does not, and may have variables of the same names.
USES_LAYER = grep -q 'pogobase\.h' $(PROGRAM_OBJECTS:.o=.d)

ifeq ($(TARGET),emu)
SDK_INCLUDES := -I$(POGOSIM_EMU_DIR) -I$(POGOSIM_INCLUDE_DIR) -I$(POGOSIM_INCLUDE_DIR)/sdk
SDK_SOURCES := $(foreach ending,.S .c,$(call names_in,$(POGOSIM_EMU_DIR),$(ending)))
SDK_OBJECTS := $(SDK_SOURCES:%=$(FIRMWARE_DIR)/emu/%.o)
LINKER_SCRIPT := $(POGOSIM_EMU_DIR)/memory.ld
SDK_LINK := $(SDK_OBJECTS) -T $(LINKER_SCRIPT) --specs=picolibc.specs -nostartfiles -lm
else
SDK_INCLUDES := -I$(POGO_SDK)/includes -I$(POGOSIM_INCLUDE_DIR)
SDK_LINK := -T $(POGO_SDK)/tools/linker.ld -N -nostdlib -L$(POGO_SDK)/libs \
    -Wl,--start-group -lcompiler_rt -lc -lpogobot -Wl,--end-group
endif

ROBOT_FLAGS := -DREAL_ROBOT -DROBOT_CATEGORY=$(ROBOT_CATEGORY) -flto -ffunction-sections -fdata-sections \
    -I. $(SDK_INCLUDES) $(addprefix -I,$(POGOUTILS_INCLUDE_DIR)) -MD -MP
# C++ is less tested: the options of C except C-only ones, and without features that are too large for robots.
CPP_FLAGS := $(filter-out -std=% -fexceptions \
    -Wstrict-prototypes -Wold-style-definition -Wmissing-prototypes,$(CFLAGS)) -std=gnu++20 -fno-exceptions -fno-rtti -fno-threadsafe-statics
CFLAGS += $(ROBOT_FLAGS)
COMPILE_CPP = $(TRIPLE)-g++ -c $(CPP_FLAGS) $(ROBOT_FLAGS) $< -o $@
LINK = $(CC) $(CPUFLAGS) -Os -flto $(PROGRAM_OBJECTS) $(UTILS_OBJECTS) $$($(USES_LAYER) && echo $(LAYER_OBJECTS)) \
    -Wl,--gc-sections $(SDK_LINK)

bin: $(FIRMWARE).bin
	@$(TRIPLE)-size $(FIRMWARE).elf
	@echo "Built $< for robots of category '$(ROBOT_CATEGORY)'"

emu: $(FIRMWARE).elf
	@$(TRIPLE)-size $<
	@echo "Built $< for robots of category '$(ROBOT_CATEGORY)': pogosim run $< -c <conf>"

$(FIRMWARE).bin: $(FIRMWARE).elf
	$(TRIPLE)-objcopy -O binary $< $@

# With a misspelt category, the robot would do nothing. The compiler removes calls for other categories.
$(FIRMWARE).elf: $(OBJECTS) $(SDK_OBJECTS) $(LINKER_SCRIPT) $(FIRMWARE_DIR)/.link
	@! $(USES_LAYER) || $(TRIPLE)-gcc-nm $(OBJECTS) | grep -q ' U _pogobot_start$$' || \
	{ echo "This program has no pogobot_start() for robots of category '$(ROBOT_CATEGORY)' (ROBOT_CATEGORY)" >&2; exit 1; }
	$(LINK) -o $@

$(FIRMWARE_DIR)/%.c.o: %.c $(FIRMWARE_DIR)/.compile
	$(compile)

$(FIRMWARE_DIR)/%.cpp.o: %.cpp $(FIRMWARE_DIR)/.compile
	$(COMPILE_CPP)

# Pogosim's folder may have blanks in its name, which the SDK's macro does not expect.
BLANK := $() $()
COMPILE_OURS = $(subst $<,$(subst $(BLANK),\ ,$<),$(compile))

$(FIRMWARE_DIR)/pogosim/%.c.o: $(POGOSIM_INTERFACE_DIR)/%.c $(FIRMWARE_DIR)/.compile
	$(COMPILE_OURS)

# Compiled apart from the program, so that nothing of them is inlined into it.
$(FIRMWARE_DIR)/emu/%.o: CFLAGS := $(filter-out -flto,$(CFLAGS))
$(FIRMWARE_DIR)/emu/%.c.o: $(POGOSIM_EMU_DIR)/%.c $(FIRMWARE_DIR)/.compile
	$(COMPILE_OURS)
$(FIRMWARE_DIR)/emu/%.S.o: $(POGOSIM_EMU_DIR)/%.S $(FIRMWARE_DIR)/.compile
	$(COMPILE_OURS)

define UTILS_RULE
$(FIRMWARE_DIR)/utils/$(notdir $(1)).o: $(1) $(FIRMWARE_DIR)/.compile
	@mkdir -p $$(@D)
	$$(compile)
endef
$(foreach file,$(UTILS_SOURCES),$(eval $(call UTILS_RULE,$(file))))

# As in the Makefile: rebuilt when options, category, SDK or the list of sources change.
$(FIRMWARE_DIR)/.compile: COMMANDS = $(CC) $(CFLAGS) $(CPP_FLAGS)
$(FIRMWARE_DIR)/.link: COMMANDS = $(LINK)
$(FIRMWARE_DIR)/.compile $(FIRMWARE_DIR)/.link: FORCE
	@mkdir -p $(@D) $(FIRMWARE_DIR)/pogosim $(FIRMWARE_DIR)/emu
	@echo '$(subst ','\'',$(COMMANDS))' | cmp -s - $@ || echo '$(subst ','\'',$(COMMANDS))' >$@
FORCE:

-include $(OBJECTS:.o=.d) $(SDK_OBJECTS:.o=.d)

# ---- connect: the SDK's serial terminal. In it, type serialboot to load the program.

TERMINAL := $(or $(POGO_TERMINAL),$(firstword $(wildcard $(POGO_SDK)/tools/*term*)))
connect:
ifeq ($(TERMINAL),)
	$(error There is no serial terminal in $(POGO_SDK)/tools: specify it with POGO_TERMINAL=<program>)
else
	@test -f $(FIRMWARE).bin || { echo "There is no $(FIRMWARE).bin yet: make bin" >&2; exit 1; }
	$(TERMINAL) --serial-boot --kernel $(FIRMWARE).bin --kernel-adr $(ROM_BASE) --safe $(TTY)
endif
