"""`Identity`: who is calling, in which role, and which collections exist for them."""

from dataclasses import dataclass

from partwise.store.records import Role, Token


@dataclass(frozen=True, slots=True)
class Identity:
    """A caller who has proved who they are, by a token of their own or by a session in a browser."""

    token: Token

    @property
    def person_id(self) -> int:
        return self.token.person_id

    @property
    def name(self) -> str:
        """The person's name, which is the actor in the audit trail."""
        return self.token.person_name

    @property
    def role(self) -> Role:
        return self.token.role

    @property
    def sees_all(self) -> bool:
        """Whether every collection exists for them."""
        return self.token.scope is None

    def may_see(self, collection_id: int) -> bool:
        """Whether the collection exists for them."""
        return self.token.opens(collection_id)
