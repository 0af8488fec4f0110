"""Laws of reception over infrared: fitting them to measurements, and what they say about how often to send."""
