"""HTML pages as the standard library's parser reads them."""

from html.parser import HTMLParser


class Page(HTMLParser):
    """Elements with attributes, and texts; `inside` holds those of scripts and styles."""

    def __init__(self, text):
        super().__init__()
        self.elements, self.texts, self.inside, self._open = [], [], {}, None
        self.feed(text)
        self.close()

    def handle_starttag(self, tag, attrs):
        self.elements.append((tag, dict(attrs)))
        self._open = dict(attrs).get("id", tag) if tag in {"script", "style"} else None

    def handle_endtag(self, tag):
        self._open = None

    def handle_data(self, text):
        self.texts.append(text)
        if self._open is not None:
            self.inside[self._open] = self.inside.get(self._open, "") + text

    def named(self, tag):
        return [attributes for name, attributes in self.elements if name == tag]

    @property
    def tags(self):
        return [tag for tag, _ in self.elements]

    @property
    def attributes(self):
        return [pair for _, attributes in self.elements for pair in attributes.items()]
