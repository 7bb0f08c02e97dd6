"""What of a robot a device on its trunk may hit, in its posture and over its joints' range."""
