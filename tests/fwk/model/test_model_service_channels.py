"""Names of the channels of services."""

from fwk.model.service_channels import ANSWERS, client_of, is_of_service, service_channel, service_of


def test_parts_of_a_name_are_those_it_was_made_of() -> None:
    requests, answers = service_channel("arm/lift", "arm/task"), service_channel("arm/lift", ANSWERS)
    assert (requests, answers) == ("arm/lift@arm/task", "arm/lift@answers")
    assert [service_of(each) for each in (requests, answers)] == ["arm/lift", "arm/lift"]
    assert [client_of(each) for each in (requests, answers)] == ["arm/task", ANSWERS]
    assert is_of_service(requests)
    assert is_of_service(answers)


def test_a_channel_of_values_has_no_client() -> None:
    assert (is_of_service("arm/pose"), service_of("arm/pose"), client_of("arm/pose")) == (False, "arm/pose", "")
