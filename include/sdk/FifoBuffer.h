/// @file
/// Queues of a fixed size, of any type of element, as macros. `queue` is a pointer.
///
///     FifoBuffer_typedef(uint8_t, ByteQueue);
///     static uint8_t memory[8];
///     ByteQueue bytes, *queue = &bytes;
///     FifoBuffer_init(queue, 8, uint8_t, memory);
#ifndef POGOSIM_SDK_FIFO_BUFFER_H
#define POGOSIM_SDK_FIFO_BUFFER_H

/// Declares a type of queue.
#define FifoBuffer_typedef(T, name) \
    typedef struct {                \
        int size;                   \
        int first;                  \
        int used;                   \
        T* elems;                   \
    } name

/// An empty queue in memory for `capacity` elements.
#define FifoBuffer_init(queue, capacity, T, memory) \
    do {                                            \
        (queue)->size = (capacity);                 \
        (queue)->first = (queue)->used = 0;         \
        (queue)->elems = (T*)(memory);              \
    } while (0)

/// Appends an element; when the queue is full, it takes the place of the oldest one.
#define FifoBuffer_write(queue, element)                                              \
    do {                                                                              \
        (queue)->elems[((queue)->first + (queue)->used) % (queue)->size] = (element); \
        if ((queue)->used < (queue)->size) {                                          \
            (queue)->used++;                                                          \
        } else {                                                                      \
            (queue)->first = ((queue)->first + 1) % (queue)->size;                    \
        }                                                                             \
    } while (0)

/// Takes out the oldest element; `element` is a variable. From an empty queue, nothing.
#define FifoBuffer_read(queue, element)                            \
    do {                                                           \
        if ((queue)->used > 0) {                                   \
            (element) = (queue)->elems[(queue)->first];            \
            (queue)->first = ((queue)->first + 1) % (queue)->size; \
            (queue)->used--;                                       \
        }                                                          \
    } while (0)

/// Copies the element that is `index` behind the oldest one.
#define FifoBuffer_peek(queue, element, index) ((element) = (queue)->elems[((queue)->first + (index)) % (queue)->size])

#define FifoBuffer_flush(queue) ((queue)->first = (queue)->used = 0)
#define FifoBuffer_count(queue) ((queue)->used)
#define FifoBuffer_is_full(queue) ((queue)->used == (queue)->size)
#define FifoBuffer_is_empty(queue) ((queue)->used == 0)
#define FifoBuffer_overflow(queue) ((queue)->used >= (queue)->size)

#endif
