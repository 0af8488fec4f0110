# The program of a real robot, for the Makefile's bin and connect: all files of the project and Pogosim's interface layer,
# compiled and linked as the Pogobot SDK says.
#
# The SDK's tools/variables.mak and tools/common.mak name the compiler and its options (TRIPLE, CC, CFLAGS and the macro
# `compile`) and the robot's addresses (ROM_BASE).
include $(POGO_SDK)/tools/variables.mak
include $(POGO_SDK)/tools/common.mak

BIN_DIR := $(BUILD_DIR)/bin
FIRMWARE := $(BIN_DIR)/firmware

.PHONY: bin connect

# ---- bin

ifneq ($(words $(ROBOT_CATEGORY)),1)
$(error ROBOT_CATEGORY is one word, found '$(ROBOT_CATEGORY)')
endif

LAYER := $(sort $(wildcard $(POGOSIM_INTERFACE_DIR)/*.c))
OBJECTS := $(SOURCES:%=$(BIN_DIR)/%.o) $(patsubst $(POGOSIM_INTERFACE_DIR)/%,$(BIN_DIR)/pogosim/%.o,$(LAYER))

ROBOT_FLAGS := -DREAL_ROBOT -DROBOT_CATEGORY=$(ROBOT_CATEGORY) -flto -ffunction-sections -fdata-sections \
    -I. -I$(POGO_SDK)/includes -I$(POGOSIM_INCLUDE_DIR) $(addprefix -I,$(POGOUTILS_INCLUDE_DIR)) -MD -MP
# C++ is tried less: as C, but for what is C only, without what robots have no room for.
CPP_FLAGS := $(filter-out -std=% -fexceptions -Wstrict-prototypes -Wold-style-definition -Wmissing-prototypes,$(CFLAGS)) \
    -std=gnu++20 -fno-exceptions -fno-rtti -fno-threadsafe-statics
CFLAGS += $(ROBOT_FLAGS)
COMPILE_CPP = $(TRIPLE)-g++ -c $(CPP_FLAGS) $(ROBOT_FLAGS) $< -o $@
LINK = $(CC) $(CPUFLAGS) -Os -flto $(OBJECTS) -T $(POGO_SDK)/tools/linker.ld -N -nostdlib -Wl,--gc-sections \
    -L$(POGO_SDK)/libs -Wl,--start-group -lcompiler_rt -lc -lpogobot -Wl,--end-group

bin: $(FIRMWARE).bin
	@$(TRIPLE)-size $(FIRMWARE).elf
	@echo "Built $< for robots of category '$(ROBOT_CATEGORY)'"

$(FIRMWARE).bin: $(FIRMWARE).elf
	$(TRIPLE)-objcopy -O binary $< $@

# A misspelt category would make a robot that does nothing. The compiler leaves out calls for other categories.
$(FIRMWARE).elf: $(OBJECTS) $(BIN_DIR)/.link
	@$(TRIPLE)-gcc-nm $(OBJECTS) | grep -q ' U _pogobot_start$$' || { echo "There is no pogobot_start() for robots of \
category '$(ROBOT_CATEGORY)' in this program (ROBOT_CATEGORY)" >&2; exit 1; }
	$(LINK) -o $@

$(BIN_DIR)/%.c.o: %.c $(BIN_DIR)/.compile
	$(compile)

$(BIN_DIR)/%.cpp.o: %.cpp $(BIN_DIR)/.compile
	$(COMPILE_CPP)

$(BIN_DIR)/pogosim/%.c.o: $(POGOSIM_INTERFACE_DIR)/%.c $(BIN_DIR)/.compile
	$(compile)

# As in the Makefile: rebuilt when options, category, SDK or the list of sources change.
$(BIN_DIR)/.compile: COMMANDS = $(CC) $(CFLAGS) $(CPP_FLAGS)
$(BIN_DIR)/.link: COMMANDS = $(LINK)
$(BIN_DIR)/.compile $(BIN_DIR)/.link: FORCE
	@mkdir -p $(@D) $(BIN_DIR)/pogosim
	@echo '$(subst ','\'',$(COMMANDS))' | cmp -s - $@ || echo '$(subst ','\'',$(COMMANDS))' >$@
FORCE:

-include $(OBJECTS:.o=.d)

# ---- connect: the SDK's serial terminal. In it, type serialboot to load the program.

TERMINAL := $(or $(POGO_TERMINAL),$(firstword $(wildcard $(POGO_SDK)/tools/*term*)))
connect:
ifeq ($(TERMINAL),)
	$(error There is no serial terminal in $(POGO_SDK)/tools: name it with POGO_TERMINAL=<program>)
else
	@test -f $(FIRMWARE).bin || { echo "There is no $(FIRMWARE).bin yet: make bin" >&2; exit 1; }
	$(TERMINAL) --serial-boot --kernel $(FIRMWARE).bin --kernel-adr $(ROM_BASE) --safe $(TTY)
endif
