/// @file
/// Functions of the robots' SDK before 2024, by their names of today. To run such a program as it is:
///
///     cc -include pogobot_old_names.h main.c -o prog $(pkg-config --cflags --libs pogosim-sdk)
///
/// `receiver_id` has never had an effect. The photosensors 1 and 2 were right and left, and are left and right now.
/// Members of the header that no longer exist (`receiver_id`, `user_tag`, `_sequence_number`) have to go.
#ifndef POGOSIM_SDK_OLD_NAMES_H
#define POGOSIM_SDK_OLD_NAMES_H

#define pogobot_infrared_sendMessageAllDirection(receiver_id, message, message_size) \
    ((void)(receiver_id), pogobot_infrared_sendLongMessage_omniGen((message), (message_size)))
#define pogobot_infrared_sendMessageAllDirectionWithId(receiver_id, message, message_size) \
    ((void)(receiver_id), pogobot_infrared_sendLongMessage_omniSpe((message), (message_size)))
#define pogobot_infrared_sendMessageOneDirection(dir, receiver_id, message, message_size) \
    ((void)(receiver_id), pogobot_infrared_sendLongMessage_uniSpe((dir), (message), (message_size)))
#define pogobot_infrared_sendMessageOnce(message) pogobot_infrared_sendRawLongMessage(message)

#endif
