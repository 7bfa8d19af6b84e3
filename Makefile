# SPDX-License-Identifier: BSD-2-Clause
# libfap. "make help" says what can be made. Everything is built under build/$(config), so configurations never mix.
# CC, CFLAGS, LDFLAGS, PREFIX and DESTDIR belong to the user; what the project needs lives in FAP_CFLAGS.

config  ?= release
B       := build/$(config)
VERSION := $(shell sed -n 's/.*FAP_VERSION_STRING "\(.*\)"/\1/p' include/fap/version.h)
MAJOR   := $(firstword $(subst ., ,$(VERSION)))
PREFIX  ?= /usr/local
LIBDIR  ?= $(PREFIX)/lib
Q       := $(if $(V),,@)
HOSTCC  ?= cc
PKG     ?= pkg-config
CFLAGS  ?= $(if $(filter asan,$(config)),-O1 -g,-O2 -g)

SAN        := $(if $(filter asan,$(config)),-fsanitize=address -fsanitize=undefined -fno-sanitize-recover=undefined -fno-omit-frame-pointer)
FAP_CFLAGS := -std=c11 -D_POSIX_C_SOURCE=200809L -Wall -Wextra -Wshadow -Wmissing-prototypes -Wstrict-prototypes -Wvla -ffp-contract=off \
              -fPIC -fvisibility=hidden -Iinclude -Ilib -I. -I$(B) -MMD -MP $(if $(WERROR),-Werror) $(SAN)

has = $(shell $(PKG) --exists $(1) 2>/dev/null && echo 1)

# --- what is there ------------------------------------------------------------------------------------------------
# Each outside library is named in exactly one driver; a missing one switches that driver off.
OSMESA  := $(call has,osmesa)
PNG     := $(call has,libpng)
SNDFILE := $(call has,sndfile)
JPEG    := $(call has,libjpeg)
ZLIB    := $(call has,zlib)
CMOCKA  := $(call has,cmocka)

# --- sources ------------------------------------------------------------------------------------------------------
notest    = $(filter-out %_test.c,$(1))
TABLES   := $(wildcard fap_tables/*.csv)
GEN      := $(TABLES:fap_tables/%.csv=$(B)/gen/%.h)
LIB_SRC  := $(call notest,$(wildcard lib/base/*.c lib/param/*.c lib/codec/*.c lib/bank/*.c lib/dsp/*.c lib/dsp/*/*.c))
STUDIO_SRC := $(call notest,$(wildcard lib/capture/*.c lib/shape/*.c))
COMMON_SRC := $(call notest,$(wildcard common/*.c))
RENDER_SRC := $(call notest,$(wildcard player/render/*.c))
ENC_SRC  := $(call notest,$(wildcard encoder/*.c encoder/*/*.c))
PLAY_SRC := $(filter-out player/render/%,$(call notest,$(wildcard player/*.c player/*/*.c)))
BANK_SRC := $(call notest,$(wildcard databank/*.c databank/*/*.c))
TEST_SRC := $(wildcard tests/*.c lib/*/*_test.c common/*_test.c encoder/*_test.c player/*_test.c player/*/*_test.c databank/*_test.c)
obj       = $(patsubst %.c,$(B)/%.o,$(1))

STUDIO_LIBS := $(if $(ZLIB),-lz) $(if $(JPEG),-ljpeg)
RENDER_LIBS := $(if $(OSMESA),-lOSMesa) $(if $(PNG),-lpng) $(if $(ZLIB),-lz)
SOUND_LIBS  := $(if $(SNDFILE),-lsndfile)
DEFS     := $(if $(OSMESA),-DHAVE_OSMESA) $(if $(PNG),-DHAVE_PNG) $(if $(SNDFILE),-DHAVE_SNDFILE) \
            $(if $(JPEG),-DHAVE_JPEG) $(if $(ZLIB),-DHAVE_ZLIB)

TOOLS    := $(B)/fapenc $(B)/fapplay $(B)/fapbank
LIBS     := $(B)/libfap.a $(B)/libfap-studio.a $(B)/libfap.so.$(VERSION)

COMPILE   = mkdir -p $(@D) && $(CC) $(FAP_CFLAGS) $(DEFS) $(CPPFLAGS) $(CFLAGS) -c -o $@ $<
LINK      = mkdir -p $(@D) && $(CC) $(SAN) $(CFLAGS) $(LDFLAGS) -o $@ $(filter %.o %.a,$^)
SAY       = $(if $(V),,@echo "  $(1) $@")

.PHONY: all help setup face test check unit cli demo bench asan fuzz install clean docs format
all: $(LIBS) $(TOOLS)

# --- tables and objects --------------------------------------------------------------------------------------------
$(B)/gen/csv2c: fap_tables/csv2c.c
	$(Q)mkdir -p $(@D) && $(HOSTCC) -O1 -o $@ $<
$(B)/gen/%.h: fap_tables/%.csv $(B)/gen/csv2c
	$(Q)$(B)/gen/csv2c $< $* $@
$(B)/%.o: %.c | $(GEN)
	$(call SAY,CC)
	$(Q)$(COMPILE)

# --- libraries -----------------------------------------------------------------------------------------------------
$(B)/libfap.a: $(call obj,$(LIB_SRC))
$(B)/libfap-studio.a: $(call obj,$(STUDIO_SRC))
$(B)/libfap-common.a: $(call obj,$(COMMON_SRC))
$(B)/libfap-render.a: $(call obj,$(RENDER_SRC))
$(B)/%.a:
	$(call SAY,AR)
	$(Q)mkdir -p $(@D) && rm -f $@ && $(AR) rcs $@ $^
$(B)/libfap.so.$(VERSION): $(call obj,$(LIB_SRC))
	$(call SAY,LD)
	$(Q)$(CC) $(SAN) -shared -Wl,-soname,libfap.so.$(MAJOR) $(LDFLAGS) -o $@ $^ -lm

# --- tools ---------------------------------------------------------------------------------------------------------
BASE := $(B)/libfap-common.a $(B)/libfap-studio.a $(B)/libfap.a
$(B)/fapenc: $(call obj,$(ENC_SRC)) $(BASE)
	$(call SAY,LD)
	$(Q)$(LINK) $(SOUND_LIBS) $(STUDIO_LIBS) $(if $(PNG),-lpng) -lm
$(B)/fapplay: $(call obj,$(PLAY_SRC)) $(B)/libfap-render.a $(BASE)
	$(call SAY,LD)
	$(Q)$(LINK) $(RENDER_LIBS) $(SOUND_LIBS) $(STUDIO_LIBS) -lm
$(B)/fapbank: $(call obj,$(BANK_SRC)) $(B)/libfap-render.a $(BASE)
	$(call SAY,LD)
	$(Q)$(LINK) $(RENDER_LIBS) $(STUDIO_LIBS) -lm

# --- tests ---------------------------------------------------------------------------------------------------------
$(B)/unit: $(call obj,$(TEST_SRC)) $(B)/libfap-render.a $(BASE)
	$(call SAY,LD)
	$(Q)$(LINK) -lcmocka $(RENDER_LIBS) $(SOUND_LIBS) $(STUDIO_LIBS) -lm

test: setup        ## install what is missing, build, fetch the face, run every test
	+$(Q)$(MAKE) --no-print-directory config=$(config) check
check: $(B)/unit all face
	$(Q)B=$(B) tests/run

unit: $(B)/unit
	$(Q)$(B)/unit

clean:
	rm -rf build
.DELETE_ON_ERROR:
.SECONDARY:
-include $(shell find $(B) -name '*.d' 2>/dev/null)
